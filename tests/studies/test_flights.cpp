#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "downwash/effects/effect_models.hpp"
#include "downwash/studies/bench_flight.hpp"
#include "downwash/studies/ceiling_flight.hpp"
#include "downwash/studies/ceiling_inspection.hpp"
#include "downwash/studies/lyapunov_decay.hpp"
#include "downwash/studies/planar_flight.hpp"

using namespace downwash;
using namespace downwash::studies;

namespace {

constexpr double degree = std::numbers::pi / 180;

PlanarExperiment over_plate(double target_m) {
    PlanarExperiment experiment;
    experiment.ground = effect_on_each_rotor(EffectModel::multirotor_body, experiment.vehicle);
    experiment.target_m = target_m;
    return experiment;
}

}  // namespace

TEST_CASE("Without a plate the planar quadrotor flies at the commanded speed and stays level at rest") {
    PlanarExperiment experiment = over_plate(7);
    experiment.has_plate = false;
    const PlanarFlight flight = fly(experiment);
    REQUIRE(!flight.is_lost);
    CHECK(flight.x_m[2000] - flight.x_m[1500] == Approx(5 * 0.2).epsilon(1e-3));
    const auto end = flight.over_last(20);
    CHECK(end.least_x_m == Approx(7).margin(1e-3));
    CHECK(end.greatest_x_m == Approx(7).margin(1e-3));
    CHECK(end.greatest_pitch_deg < 0.01);
    CHECK(flight.z_m.back() == Approx(2 * 0.12).margin(1e-9));
}

TEST_CASE("A PID that takes one rotor over a plate settles where its own torque balances the ground's, if it settles") {
    // With Cheeseman and Bennett's weak effect it rests short of the target: pitch zero, so that x_ref - x makes up for
    // the tilt that the torque asks for.
    PlanarExperiment experiment = over_plate(2.8);
    experiment.ground = effect_on_each_rotor(EffectModel::cheeseman_bennett, experiment.vehicle);
    experiment.duration_s = 160;
    const PlanarFlight flight = fly(experiment);
    const auto end = flight.over_last(5);
    REQUIRE(end.greatest_x_m - end.least_x_m < 1e-3);
    const double x = end.least_x_m;
    // The covered share of the front disc, and the pitch torque of its extra thrust.
    const double s = (x + 0.25 - 3) / 0.12;
    const double share = 0.5 + (std::asin(s) + s * std::sqrt(1 - s * s)) / std::numbers::pi;
    const double zeta = flight.z_m.back() / 0.12;
    const double k = 1 / (1 - 1 / (16 * zeta * zeta));
    const double thrust_n =
        1.5 * 9.80665 / (4 + share * (k - 1));                   // of each rotor in free air, all together the weight
    const double torque_nm = 0.25 * share * (k - 1) * thrust_n;  // nose up
    const double tilt_rad = torque_nm / (0.02 * 4 * 8);          // that the law asks for in vain
    CHECK(9.80665 * std::tan(tilt_rad) == Approx(1.5 * 0.8 * (2.8 - x)).epsilon(0.03));
}

TEST_CASE("With the ground's effect read from the right map the plate is as if it were not there") {
    PlanarExperiment experiment = over_plate(2.8);
    experiment.control.map_offset_m = 0;
    const PlanarFlight flight = fly(experiment);
    const auto end = flight.over_last(20);
    CHECK(end.least_x_m == Approx(2.8).margin(2e-3));
    CHECK(end.greatest_pitch_deg < 0.05);
}

TEST_CASE("On the bench the pitch stays where the cascade balances the plate, and an observer brings it back") {
    BenchExperiment experiment;
    experiment.ground = effect_on_each_rotor(EffectModel::cheeseman_bennett, experiment.vehicle);
    experiment.plate_to_s = experiment.end_s = 40;
    const double pitch_rad = fly(experiment).pitch_at(39) * degree;
    CHECK(pitch_rad < 0);  // nose up
    const double zeta = 2 - 0.25 * std::sin(pitch_rad) / 0.12;
    const double k = 1 / (1 - 1 / (16 * zeta * zeta));
    // Front rotor: a quarter of the weight, less what the law takes away; both its and the rear one's torque.
    const double command_nm = -0.02 * 4 * 8 * pitch_rad;
    const double front_n = 1.5 * 9.80665 / 4 - command_nm / (2 * 0.25);
    CHECK(command_nm == Approx(0.25 * (k - 1) * front_n).epsilon(2e-3));
    experiment.aid = BenchAid::observer;
    CHECK(std::abs(fly(experiment).pitch_at(39)) < 1e-3);
    experiment.aid = BenchAid::feed_forward;
    CHECK(fly(experiment).peak_deg(0, 40) < 1e-6);
}

TEST_CASE(
    "In contact the Lyapunov law commands what presses as asked over K_c, and the frame enters by less than 2 mm") {
    const CeilingExperiment experiment;
    const CeilingFlight flight = fly(experiment);
    const double k = ceiling_factor_at(experiment.vehicle, experiment.vehicle.guard_m);
    // At rest 2 cm below the reference: m (g + (k^2 - 1) e - (k + k') k e) with k = k' = 2.
    const double pressing = 1 + (3 * -0.02 + 4 * 2 * 0.02) / 9.80665;
    CHECK(flight.command_in_contact() == Approx(pressing / k).epsilon(0.01));
    CHECK(flight.max_depth_m < 2e-3);
    REQUIRE(flight.delay_s());
    CeilingExperiment unaware = experiment;
    unaware.law = AltitudeLaw::lyapunov_unaware;
    CHECK(fly(unaware).command_in_contact() == Approx(pressing).epsilon(0.01));
}

TEST_CASE("A mission of four contacts holds each of them, and without K_c the vehicle does not come down in time") {
    const CeilingInspection mission;
    const CeilingInspectionFlight flight = fly(mission);
    CHECK(flight.contacts_held == 4);
    CHECK(flight.always_leaves);
    CHECK(flight.delay_s < 0.3);
    CHECK(flight.below_travel_m < 0.1);
    // Between two points the vehicle tilts as far as a step of the reference's speed asks for: k' = 1/s times 0.3 m/s.
    CHECK(flight.max_tilt_deg > 1);
    CHECK(flight.max_tilt_deg < 10);
    // 12 s of climbs, holds and descents and two rests at each of four points, and three legs of 1 m between them.
    CHECK(flight.time_s.size() == Approx(100 * (4 * (6 + 2 * 3 + 2 * 0.42 / 0.3) + 3 / 0.3)).margin(20));
    CHECK(flight.x_m.back() == Approx(2).margin(0.01));
    CHECK(flight.y_m.back() == Approx(1).margin(0.01));
    CeilingInspection unaware = mission;
    unaware.knows_ceiling = false;
    CHECK_FALSE(fly(unaware).always_leaves);
}

TEST_CASE("The altitude law keeps its promise to rounding, and nearly so with a command held for 10 ms") {
    const LyapunovDecay decay = lyapunov_decay();
    CHECK(decay.worst_rate_error < 1e-6);
    CHECK(decay.sampled_excess < 0.01);
    CHECK(decay.sampled_excess > 1e-5);  // or nothing was sampled
}
