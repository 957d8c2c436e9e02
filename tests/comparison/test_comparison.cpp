#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <optional>

#include "../support/log_writers.hpp"
#include "../support/scratch_folder.hpp"
#include "../support/test_problem.hpp"
#include "downwash/comparison/log_comparison.hpp"
#include "downwash/logs/log_reader.hpp"
#include "downwash/logs/rotation.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/space_solution_file.hpp"
#include "downwash/results/trajectory_csv.hpp"
#include "downwash/simulation/world_parameters.hpp"

// Flights of the simulator are written as logs in every format, in a frame and clock of their own, and compared with
// their plans: what is found is what was put in.

using namespace downwash;
using namespace downwash::test;

namespace {

const SpaceProblem& girder() {
    static const SpaceProblem problem = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    return problem;
}

const SpacePlan& girder_plan() {
    static const SpacePlan plan = *read_solution(DOWNWASH_PROBLEMS "/space/around_a_girder.json", girder()).plan;
    return plan;
}

/// The flight of that plan, as a log may have it. @param push_m by how much the vehicle is moved from 5 s to 6 s
LoggedFlight girder_flight(const Vector3& push_m = {}) {
    static const SpaceFlight flight = SpaceProblemModel(girder()).execute(girder_plan());
    LoggedFlight logged;
    for (std::size_t i = 0; i < flight.rows.size(); i += 2) {
        const SpaceFlightRow& row = flight.rows[i];
        LoggedMoment moment;
        moment.t_s = row.t_s;
        moment.position_m = row.t_s >= 5 && row.t_s <= 6 ? row.motion.position_m + push_m : row.motion.position_m;
        moment.velocity_m_s = row.motion.velocity_m_s;
        moment.attitude = row.motion.attitude;
        moment.body_rates_rad_s = row.motion.body_rates_rad_s;
        moment.joints_rad.assign(row.motion.joints_rad.begin(), row.motion.joints_rad.begin() + flight.joints);
        moment.rotor_n.assign(row.rotor_command_n, row.rotor_command_n + flight.rotor_count);
        logged.push_back(std::move(moment));
    }
    return logged;
}

const ComparedPlan& compared_girder() {
    static const auto plan = compared_plan(girder(), girder_plan());
    return *plan;
}

/// Errors of the yaw of a flight, from its rows.
AngleFigures yaw_errors_of(const SpaceFlight& flight) {
    AngleFigures errors;
    for (const SpaceFlightRow& row : flight.rows) {
        const auto& q = row.motion.attitude;
        const double yaw = std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
        const double error = std::remainder(yaw - row.reference.position[space::yaw], 6.283185307179586);
        errors.max_rad = std::max(errors.max_rad, std::abs(error));
        errors.rms_rad += error * error / static_cast<double>(flight.rows.size());
    }
    errors.rms_rad = std::sqrt(errors.rms_rad);
    return errors;
}

FlightLog read(const std::string& bytes, const std::string& name, const LogOptions& options = {}) {
    const ScratchFolder folder;
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return read_flight_log({folder / name}, options);
}

/// Whether an alignment is the frame that a log was written in.
void check_alignment(const LogAlignment& found, const LogFrame& frame, double start_s) {
    CHECK(found.offset_s == Approx(frame.offset_s - start_s).margin(0.01));
    CHECK(found.rate == Approx(1).margin(1e-3));
    CHECK(std::cos(found.yaw_rad - frame.yaw_rad) == Approx(1).margin(1e-5));
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(found.shift_m[i] == Approx(frame.shift_m[i]).margin(0.01));
    }
    CHECK(found.residual_m < 0.005);
}

}  // namespace

TEST_CASE("A flight in space is found again in ULog, DataFlash and CSV, in another frame and clock") {
    const LogFrame frame{0.9, {12, -7, 3}, 40, 1};
    LoggedFlight flight = girder_flight();
    // It has waited on the ground for ten seconds before.
    for (int i = 500; i-- > 0;) {
        LoggedMoment moment = flight.front();
        moment.t_s -= 0.02;
        flight.insert(flight.begin(), moment);
    }
    const LoggedFlight logged = in_frame(flight, frame);
    const double start_s = logged.front().t_s;
    const double full_n = 20;
    const SpaceFlight flown = SpaceProblemModel(girder()).execute(girder_plan());
    for (const auto& [name, bytes] : {std::pair<std::string, std::string>{"flight.ulg", ulog_of(logged, full_n)},
                                      {"flight.bin", dataflash_of(logged, full_n)},
                                      {"flight.bag", bag_of(logged)},
                                      {"flight.csv", pandas_csv_of(logged)}}) {
        INFO(name);
        const LogComparison comparison = compare(read(bytes, name), compared_girder());
        check_alignment(comparison.alignment, frame, start_s);
        CHECK(comparison.alignment.covered == 1);
        CHECK(comparison.from_planned.rms_m[3] < 0.005);
        CHECK(comparison.has_attitude);
        CHECK(comparison.has_joints == (name == "flight.bag"));
        CHECK(comparison.joints.size() == (comparison.has_joints ? 3 : 0));
        REQUIRE(comparison.yaw);
        CHECK(comparison.yaw->rms_rad == Approx(yaw_errors_of(flown).rms_rad).epsilon(0.03));
        CHECK(comparison.clearance.clearance_m == Approx(comparison.planned_clearance.clearance_m).margin(0.01));
        CHECK(comparison.thrust.has_value() == (name == "flight.ulg" || name == "flight.bin"));
        if (comparison.thrust) {
            CHECK(comparison.thrust->unit_n == Approx(full_n).epsilon(0.01));
            CHECK(comparison.thrust->rms_with_effects_n < comparison.thrust->rms_in_free_air_n);
        }
    }
}

TEST_CASE("A log of the very same flight has no error from it, and its own errors from the reference") {
    LoggedFlight flight = girder_flight();
    const SpaceFlight flown = SpaceProblemModel(girder()).execute(girder_plan());
    const LogComparison comparison =
        compare(read(ulog_of(in_frame(flight, {0, {}, 1, 1}), 20), "flight.ulg"), compared_girder());
    CHECK(comparison.from_planned.max_m[3] < 0.003);
    CHECK(comparison.tracking.max_m[3] == Approx(flown.max_tracking_error_m).margin(0.005));
    REQUIRE(comparison.yaw);
    CHECK(comparison.yaw->max_rad == Approx(yaw_errors_of(flown).max_rad).margin(0.002));
    CHECK(comparison.joints.empty());
    double samples = 0;
    for (const PhaseFigures& phase : comparison.phases) {
        samples += static_cast<double>(phase.errors.samples);
    }
    CHECK(samples == static_cast<double>(comparison.tracking.samples));
    CHECK(comparison.phases.back().phase == FlightPhase::hover);
    CHECK(comparison.planned_clearance.clearance_m == Approx(flown.min_clearance_m).margin(1e-9));
}

TEST_CASE("A push aside shows in tracking, and as a time outside of what the worlds allow") {
    ComparisonOptions options;
    options.alignment.is_in_world = true;
    options.worlds = {1, 1, 6, 2, {}};
    const FlightLog log = read(ulog_of(in_frame(girder_flight({0, 0, 0.4}), {0, {}, 1, 1}), 20), "flight.ulg");
    const LogComparison comparison = compare(log, compared_girder(), options);
    CHECK(comparison.tracking.max_m[2] == Approx(0.4).margin(0.1));
    CHECK(comparison.tracking.max_at_s >= 4.9);
    CHECK(comparison.tracking.max_at_s <= 6.1);
    REQUIRE(comparison.envelope);
    CHECK(comparison.envelope->envelope.flown == 6);
    CHECK(comparison.envelope->expected_axis_share == Approx(2.0 / 7));
    const auto& outside = comparison.envelope->outside;
    const auto worst = std::max_element(outside.begin(), outside.end(), [](const OutsideTime& a, const OutsideTime& b) {
        return a.excess_m < b.excess_m;
    });
    REQUIRE(worst != outside.end());
    CHECK(worst->axis == 2);
    CHECK(worst->begin_s <= 5.05);
    CHECK(worst->end_s >= 5.95);
    CHECK(worst->excess_m > 0.2);
}

TEST_CASE("A jump of the log is told at its time of the plan, and tracking without what follows it") {
    LoggedFlight flight = girder_flight();
    for (LoggedMoment& moment : flight) {
        moment.position_m[0] += moment.t_s >= 5 && moment.t_s < 6 ? 0.5 : 0;
    }
    ComparisonOptions options;
    options.alignment.is_in_world = true;
    const LogComparison comparison =
        compare(read(ulog_of(in_frame(flight, {0, {}, 1, 1}), 20), "flight.ulg"), compared_girder(), options);
    REQUIRE(comparison.jumps.size() == 2);
    CHECK(comparison.jumps[0].t_s == Approx(5).margin(0.1));
    CHECK(comparison.jumps[0].step_m[0] == Approx(0.5).margin(0.05));
    CHECK(comparison.jumps[1].step_m[0] == Approx(-0.5).margin(0.05));
    CHECK(comparison.tracking.max_m[3] > 0.4);
    CHECK(comparison.tracking_apart.max_m[3] < 0.2);
    CHECK(comparison.tracking_apart.samples < comparison.tracking.samples);
}

TEST_CASE("A log with the flight in it twice says where the other one is") {
    LoggedFlight flight = girder_flight();
    const std::size_t once = flight.size();
    const double again_s = flight.back().t_s + 40;
    for (std::size_t i = 0; i < once; ++i) {
        LoggedMoment moment = flight[i];
        moment.t_s += again_s;
        moment.position_m[2] += 0.02 * std::sin(moment.t_s);
        flight.push_back(moment);
    }
    const LogComparison comparison =
        compare(read(ulog_of(in_frame(flight, {0, {}, 1, 1}), 20), "flight.ulg"), compared_girder());
    CHECK(comparison.alignment.offset_s == Approx(0).margin(0.02));
    REQUIRE(comparison.alignment.remarks.size() == 1);
    CHECK(comparison.alignment.remarks[0].find("another flight much like the plan: --time-offset ") !=
          std::string::npos);
}

TEST_CASE("The envelope of worlds does not depend on the number of threads") {
    const EnvelopeWorlds one{1, 1, 2, 1, {}}, two{1, 1, 2, 2, {}};
    const WorldEnvelope a = world_envelope(compared_girder(), girder_plan().tick_s, one);
    const WorldEnvelope b = world_envelope(compared_girder(), girder_plan().tick_s, two);
    CHECK(a.low_m == b.low_m);
    CHECK(a.high_m == b.high_m);
}

TEST_CASE("A flight in a plane is compared in its plane, from our own trajectory.csv and from a log elsewhere") {
    Problem problem = ceiling_problem();
    problem.plane = PlaneOfMotion({3, 2, 0}, 0.7);
    problem.goal = configuration_goal(1, 3);
    problem.uncertainty.emplace();
    Plan plan;
    plan.tick_s = 1.0 / problem.robot.controller.rate_hz;
    const auto knot = [&](double t_s, double x_m, double z_m) {
        ReferenceKnot at;
        at.tick = std::llround(t_s / plan.tick_s);
        at.point.position[plane::x] = x_m;
        at.point.position[plane::z] = z_m;
        at.point.position[plane::arm] = problem.start.at[plane::arm];
        plan.reference.push_back(at);
    };
    knot(0, -4, 2);
    knot(8, 0, 2.5);
    knot(12, 1, 3);
    const auto compared = compared_plan(problem, plan);
    const auto model = make_flight_model(problem);
    const std::vector<Goal> goals = goals_of(problem);
    const Execution flight = execute(*model, start_state(*model, problem.start), plan.reference, goals, true);
    ComparisonOptions options;
    options.worlds = {1, 1, 4, 1, {}};

    const LogComparison own = compare(read(trajectory_csv(flight), "trajectory.csv"), *compared, options);
    CHECK(own.alignment.offset_s == Approx(0).margin(0.005));
    CHECK(own.alignment.yaw_rad == Approx(0).margin(1e-3));
    CHECK(own.from_planned.max_m[3] < 0.003);
    CHECK(own.has_joints);
    CHECK_FALSE(own.yaw);
    REQUIRE(own.joints.size() == 1);
    CHECK(own.joints[0].max_rad > 0);
    CHECK(own.joints[0].max_rad < 0.1);
    CHECK(own.clearance.clearance_m == Approx(flight.min_clearance_m).margin(0.003));
    REQUIRE(own.thrust);
    CHECK(own.thrust->unit_n == 1);
    CHECK(own.thrust->rms_with_effects_n < 0.05);
    REQUIRE(own.envelope);
    CHECK(std::none_of(own.envelope->outside.begin(), own.envelope->outside.end(),
                       [](const OutsideTime& time) { return time.axis == 1; }));

    LoggedFlight logged;
    for (const FlightRow& row : flight.rows) {
        LoggedMoment moment;
        moment.t_s = row.t_s;
        moment.position_m = {row.q[0], 0, row.q[1]};
        moment.attitude = quaternion_of_angles(0, row.q[2], 0);
        logged.push_back(moment);
    }
    const LogFrame frame{-1.1, {3, 2, 1}, 17, 1};
    const LogComparison elsewhere = compare(read(ulog_of(in_frame(logged, frame), 20), "flight.ulg"), *compared);
    check_alignment(elsewhere.alignment, frame, 17);
    CHECK(elsewhere.clearance.clearance_m == Approx(flight.min_clearance_m).margin(0.01));
}
