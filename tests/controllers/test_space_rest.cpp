#include <catch2/catch.hpp>

#include "downwash/base/numbers.hpp"
#include "downwash/controllers/aided_control.hpp"
#include "downwash/controllers/model_inversion_control.hpp"
#include "downwash/controllers/space_rest.hpp"
#include "planar_twin.hpp"
#include "space_loop.hpp"

using namespace downwash;
using namespace downwash::controllers;
using namespace downwash::test;

namespace {

/// Each rotor has a K of its own, the same everywhere: the law without a map believes in a wrench that does not act.
const double ratio_of[max_rotors] = {1.1, 1.2, 1.05, 1.15, 1.3, 1.0, 1, 1};
const RatiosInSpace uneven([](int rotor, double, double, double) { return ratio_of[rotor]; });

/// A vehicle with its arm aside, at rest among these, and the commands that hold it.
template <int n>
struct Resting {
    SpaceLawModel<n> nominal = law_model_of<n>(hexarotor(n));
    dynamics::SpaceState<double, n> state = hovering<n>(nominal.plant);
    dynamics::SpaceCommand<double, n> given{};
    SpaceRestingCommand<n> command{};

    explicit Resting(bool law_reads) {
        state.q[0] = 1;
        const double half_yaw = 0.4;
        state.q[3] = std::cos(half_yaw);
        state.q[6] = std::sin(half_yaw);
        for (int i = 0; i < n; ++i) {
            state.q[7 + i] = 0.5 - 0.3 * i;
        }
        // Level: what the arm weighs needs a torque.
        const double still[6 + n]{};
        const auto places = dynamics::places_at(nominal.plant, state.q);
        const auto e = dynamics::equations_of_motion(nominal.plant, places, still);
        const dynamics::LaneVector<double> up{0, 0, standard_gravity_m_s2};
        // What the law asks for until that acts which has to: a law without a map knows nothing of K.
        const dynamics::LaneVector<double> torque = cross(e.first_moment_kg_m, up);
        const double* known = law_reads ? ratio_of : nullptr;
        SpaceDemand<double> demand{0, {0, 0, 0}};
        for (int round = 0; round < 200; ++round) {
            double tilt_n[max_rotors], yaw_n[max_rotors];
            acting_thrusts(nominal, known, demand, tilt_n, yaw_n);
            for (int i = 0; i < nominal.plant.rotor_count; ++i) {
                given.thrust_n[i] = state.thrust_n[i] = (tilt_n[i] + yaw_n[i]) / (law_reads ? ratio_of[i] : 1);
            }
            const auto acting = wrench_of(nominal.plant, ratio_of, given.thrust_n);
            demand.lift_n += nominal.plant.total_mass_kg * standard_gravity_m_s2 - acting.force_n.z;
            demand.torque_nm = demand.torque_nm + (torque - acting.torque_nm);
        }
        std::copy(state.q, state.q + 7 + n, command.q);
        command.wrench = wrench_of(nominal.plant, known, given.thrust_n);
        for (int i = 0; i < n; ++i) {
            command.joint_torque_nm[i] = given.joint_torque_nm[i] = dot(e.joint_push_kg_m[i], up);
        }
    }
};

struct UnevenMap {
    [[nodiscard]] double ratio(int rotor, const dynamics::LaneVector<double>& /*hub_m*/) const {
        return ratio_of[rotor];
    }
};

/// From the memory of space_rest() and with its reference the law gives the commands of rest, and remembers the same.
template <int n, class Law>
void check_rest(const Law& law, bool law_reads) {
    const Resting<n> at(law_reads);
    const auto rest = space_rest(law, at.nominal, at.command);
    REQUIRE(rest.limit == HoldLimit::none);
    BasicSpacePoint<double, n> reference{};
    for (int i = 0; i < 4 + n; ++i) {
        const double place = i < 3 ? at.state.q[i] : i == space::yaw ? 0.8 : at.state.q[3 + i];
        reference.position[i] = place + rest.error[i];
    }
    dynamics::SpaceCommand<double, n> given;
    typename Law::template Memory<double, n> next;
    const double saturation =
        law.control(at.nominal, at.state, rest.memory, reference, space_tick_s, UnevenMap{}, given, next);
    CHECK(saturation < 1);
    double worst = 0;
    for (int i = 0; i < at.nominal.plant.rotor_count; ++i) {
        worst = std::max(worst, std::abs(given.thrust_n[i] - at.given.thrust_n[i]));
    }
    for (int i = 0; i < n; ++i) {
        worst = std::max(worst, std::abs(given.joint_torque_nm[i] - at.given.joint_torque_nm[i]));
    }
    CHECK(worst < 1e-9);
    using Memory = typename Law::template Memory<double, n>;
    for (int i = 0; i < number_count<double, Memory>; ++i) {
        CAPTURE(i);
        CHECK(number_at<double>(next, i) == Approx(number_at<double>(rest.memory, i)).margin(1e-9));
    }
    // And there it stays: the plant among these surfaces does not move.
    const auto moved = dynamics::space_step(at.nominal.plant, at.state, given, space_tick_s, uneven);
    for (int i = 0; i < 6 + n; ++i) {
        CHECK(std::abs(moved.u[i]) < 1e-9);
    }
}

}  // namespace

TEST_CASE("From the memory at rest every law in space holds the vehicle where it is") {
    SpaceInversion law = gains_for(0.02, {});
    for (const double observer : {0.0, 3.0}) {
        for (const bool reads : {false, true}) {
            law.observer_gain_1_s = observer;
            law.feed_forward = reads;
            CAPTURE(observer, reads);
            check_rest<0>(law, reads);
            check_rest<2>(law, reads);
            check_rest<3>(law, reads);
        }
    }
    Px4Cascade cascade;
    cascade.yaw_rate.ki_1_s2 = 3;
    check_rest<0>(cascade, false);
    check_rest<2>(cascade, false);
}

TEST_CASE("Without integrals a law in space settles off its reference, and without gains it cannot") {
    SpaceInversion law = gains_for(0.02, {});
    law.observer_gain_1_s = 0;
    law.horizontal.ki_1_s3 = law.height.ki_1_s3 = law.joint.ki_1_s3 = law.rate_ki_1_s2 = 0;
    check_rest<0>(law, false);
    check_rest<2>(law, false);
    const Resting<2> at(false);
    const auto rest = space_rest(law, at.nominal, at.command);
    CHECK(std::abs(rest.error[space::z]) > 0.05);
    CHECK(rest.height_gain_1_s2 == law.height.kp_1_s2);
    law.height.kp_1_s2 = 0;
    CHECK(space_rest(law, at.nominal, at.command).limit == HoldLimit::gain);
    law.max_tilt_rad = 1e-4;
    CHECK(space_rest(law, at.nominal, at.command).limit == HoldLimit::tilt);
}

TEST_CASE("In the plane the rest in space is the planar one") {
    for (const bool observes : {false, true}) {
        for (const double integral : {0.0, 1.0}) {
            Robot robot = shipped_robot();
            ModelInversion& law = gains_of(robot);
            if (!observes) {
                law.aids.observer.reset();
            }
            law.position_ki *= integral;
            law.height_ki = *law.height_ki * integral;
            law.arm_ki *= integral;
            law.attitude_rate_ki *= integral;
            const PlantModel plane = plant_of(robot);
            dynamics::PlantState<double> planar{{0.3, 1.2, 0, 0.6}, {}, {}, 0};
            const double still[4]{};
            const auto equations = dynamics::motion_at(plane, planar.q, still).equations;
            const RestingCommand given{{45, -2.4}, -2.3, {}};
            const auto expected = Aided<ModelInversion>{law}.rest(plane, equations, given);

            const SpaceLawModel<1> nominal = law_model_of(robot);
            SpaceRestingCommand<1> command{};
            const auto state = lifted(planar);
            std::copy(state.q, state.q + 8, command.q);
            command.wrench = {{0, 0, 45}, {0, -2.4, 0}};
            command.joint_torque_nm[0] = -2.3;
            const auto found = space_rest(from_planar(law), nominal, command);
            CHECK(found.limit == expected.limit);
            CHECK(found.error[space::x] == Approx(expected.error[0]).margin(1e-12));
            CHECK(found.error[space::z] == Approx(expected.error[1]).margin(1e-12));
            CHECK(found.error[space::first_joint] == Approx(expected.error[2]).margin(1e-12));
            CHECK(found.memory.position_integral[0] ==
                  Approx(expected.memory.loops.position_integral[0]).margin(1e-12));
            CHECK(found.memory.position_integral[2] ==
                  Approx(expected.memory.loops.position_integral[1]).margin(1e-12));
            CHECK(found.memory.rate_integral[1] == Approx(expected.memory.loops.pitch_rate_integral).margin(1e-12));
            CHECK(found.memory.joint_integral[0] == Approx(expected.memory.loops.arm_integral).margin(1e-12));
            CHECK(std::atan2(found.memory.direction[0], found.memory.direction[2]) ==
                  Approx(expected.pitch_reference_rad).margin(1e-12));
            CHECK(found.memory.observed[0] == Approx(expected.memory.observed[0]).margin(1e-12));
            CHECK(found.memory.observed[2] == Approx(expected.memory.observed[1]).margin(1e-12));
            CHECK(found.memory.observed[4] == Approx(expected.memory.observed[2]).margin(1e-12));
            CHECK(found.memory.observed[6] == Approx(expected.memory.observed[3]).margin(1e-12));
            CHECK(found.height_gain_1_s2 == expected.height_gain_1_s2);
            CHECK(found.tilt_gain_1_s2 == expected.pitch_gain_1_s2);
        }
    }
}
