#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "../support/random.hpp"
#include "../support/space_robots.hpp"
#include "downwash/simulation/space_hold_map.hpp"
#include "hover_scenes.hpp"
#include "space_twin.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

std::shared_ptr<const Scene> scene_of(std::vector<Obstacle> obstacles) {
    return std::make_shared<const Scene>(std::move(obstacles));
}

AeroSettings calm() {
    AeroSettings aero;
    aero.enabled = false;
    return aero;
}

SpacePoint place_of(const SpaceRobot& robot, const Vector3& at_m, double yaw_rad, double joint_rad) {
    SpacePoint place;
    std::copy(at_m.begin(), at_m.end(), place.position);
    place.position[space::yaw] = yaw_rad;
    std::fill_n(place.position + space::first_joint, robot.joints(), joint_rad);
    return place;
}

/// K = 1 where the rotors of a hover are, and a random slope of its own for each of them.
class Slopes final : public simulation::SpaceEffect {
 public:
    /// @param at_m where the vehicle hovers   @param scale_1_m greatest slope along each axis
    Slopes(const SpaceRobot& robot, const Vector3& at_m, double scale_1_m, Random& random) {
        for (const SpaceRotor& rotor : robot.plant.rotors) {
            hub_m_.push_back(at_m + rotor.position_m);
            const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(0, 1);
            slope_1_m_.push_back(scale_1_m * Vector3{x, y, z});
        }
    }

    SidedFactor<double> at_rotor(int rotor, const dynamics::LaneVector<double>& at_m) override {
        const auto i = static_cast<std::size_t>(rotor);
        const Vector3 from_m = Vector3{at_m.x, at_m.y, at_m.z} - hub_m_[i];
        return {1 + dot(slope_1_m_[i], from_m), 1};
    }

 private:
    std::vector<Vector3> hub_m_, slope_1_m_;
};

/// A surface effect less what it is at a hover, where K is 1: slopes remain, those of the attitude included, and are
/// steeper by a factor.
class LessThanHere final : public simulation::SpaceEffect {
 public:
    LessThanHere(simulation::SpaceEffect& surfaces, const SpaceRobot& robot, const Vector3& at_m, double yaw_rad,
                 double steeper)
        : surfaces_(surfaces), steeper_(steeper) {
        const dynamics::LaneVector<double> at{at_m[0], at_m[1], at_m[2]};
        const double q[] = {std::cos(0.5 * yaw_rad), 0, 0, std::sin(0.5 * yaw_rad)};
        const auto attitude = dynamics::rotation_of(q);
        dynamics::LaneVector<double> center{};
        for (const SpaceRotor& rotor : robot.plant.rotors) {
            const auto [x, y, z] = rotor.position_m;
            const auto place = attitude * dynamics::LaneVector<double>{x, y, z};
            center = center + 1.0 / static_cast<double>(robot.plant.rotors.size()) * place;
            here_.push_back(surfaces.at_turned_rotor(static_cast<int>(here_.size()), at + place, attitude));
        }
        body_here_ = surfaces.at_turned_body(at + center, attitude);
    }

    SidedFactor<double> at_rotor(int /*rotor*/, const dynamics::LaneVector<double>& /*at_m*/) override {
        throw std::logic_error("K of several rotors has an attitude");
    }
    SidedFactor<double> at_turned_rotor(int rotor, const dynamics::LaneVector<double>& at_m,
                                        const dynamics::LaneRotation<double>& attitude) override {
        const SidedFactor<double>& here = here_[static_cast<std::size_t>(rotor)];
        const SidedFactor<double> there = surfaces_.at_turned_rotor(rotor, at_m, attitude);
        return {1 + steeper_ * (there.all - here.all), 1 + steeper_ * (there.above - here.above)};
    }
    SidedFactor<double> at_turned_body(const dynamics::LaneVector<double>& at_m,
                                       const dynamics::LaneRotation<double>& attitude) override {
        return {1 + steeper_ * (surfaces_.at_turned_body(at_m, attitude).all - body_here_.all), 1};
    }

 private:
    simulation::SpaceEffect& surfaces_;
    double steeper_;
    std::vector<SidedFactor<double>> here_;
    SidedFactor<double> body_here_{1, 1};
};

/// How far a vehicle is from where it should rest, place and attitude.
double off(const SpaceMotion& a, const SpaceMotion& b) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        square += (a.position_m[i] - b.position_m[i]) * (a.position_m[i] - b.position_m[i]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        square += (a.attitude[i] - b.attitude[i]) * (a.attitude[i] - b.attitude[i]);
    }
    for (std::size_t i = 0; i < max_joints; ++i) {
        square += (a.joints_rad[i] - b.joints_rad[i]) * (a.joints_rad[i] - b.joints_rad[i]);
    }
    return std::sqrt(square);
}

/// The rate at which a small disturbance of a hover grows in a flight, from two equally long stretches: how much larger
/// the greatest distance is in the second one.
double flown_rate_1_s(const SpaceRobot& robot, simulation::SpaceEffect& effect, const SpaceHoverTrim& trim,
                      double disturbed_m, double settle_s, double stretch_s, const simulation::SpaceAero& aero = {}) {
    simulation::SpaceLoopSetup setup{.robot = robot, .effect = effect, .aero = aero, .is_refined = false};
    const auto loop = simulation::make_space_loop(setup);
    SpaceMotion start = trim.motion;
    start.position_m = start.position_m + disturbed_m * Vector3{1, -0.7, 0.8};
    start.body_rates_rad_s = disturbed_m * Vector3{1, 1.3, -1};
    loop->start(start);
    const double tick_s = 1 / robot.controller.rate_hz;
    const auto ticks = [&](double time_s) { return static_cast<int>(std::lround(time_s / tick_s)); };
    SpaceFlightRow row;
    for (int i = 0; i < ticks(settle_s); ++i) {
        loop->quiet_tick(trim.reference, row);
    }
    double greatest[2] = {};
    for (double& most : greatest) {
        for (int i = 0; i < ticks(stretch_s); ++i) {
            loop->quiet_tick(trim.reference, row);
            most = std::max(most, off(loop->motion(), trim.motion));
        }
    }
    return std::log(greatest[1] / greatest[0]) / stretch_s;
}

}  // namespace

TEST_CASE("In free air a vehicle in space hovers where it is asked to, with any arm and under either law") {
    const int joints = GENERATE(range(0, max_built_joints() + 1));
    SpaceRobot robot = space_robot(joints);
    const SpaceHover hover(robot, scene_of({}), calm());
    const SpacePoint place = place_of(robot, {1, -2, 3}, 0.7, 0.3);
    for (const SpaceLaw& law : {SpaceLaw(gains_for(0.03, {})), SpaceLaw(cascade_gains_for(0.03, {}))}) {
        robot.controller.law = law;
        const SpaceHoverAnalysis analysis = hover.at(place);
        CAPTURE(joints, law.index());
        REQUIRE(analysis.trim.limit == HoldLimit::none);
        CHECK(analysis.trim.saturation < 1);
        if (analysis.verdict != HoldVerdict::stable) {
            REQUIRE(law.index() == 1);  // a cascade knows no arm
            REQUIRE(joints > 0);
            continue;
        }
        // A flight from the equilibrium does not leave it, however long.
        simulation::NoEffectInSpace nothing;
        const auto loop = simulation::make_space_loop({.robot = robot, .effect = nothing, .is_refined = false});
        loop->start(analysis.trim.motion);
        SpaceFlightRow row;
        for (int i = 0; i < 6000; ++i) {
            loop->quiet_tick(analysis.trim.reference, row);
        }
        // With longer arms, which lean it more, it hovers with a yaw up to 1e-5 beside that of the trim.
        CHECK(off(loop->motion(), analysis.trim.motion) < (joints <= 3 ? 1e-6 : 1e-5));
        for (std::size_t i = 0; i < robot.plant.rotors.size(); ++i) {
            CHECK(row.rotor_command_n[i] == Approx(analysis.trim.rotor_command_n[i]).margin(1e-5));
        }
    }
}

TEST_CASE("A vehicle whose rotors lean to one side leans to the other to hover") {
    SpaceRobot robot = space_robot(2);
    for (SpaceRotor& rotor : robot.plant.rotors) {
        rotor.axis = rotor.axis + Vector3{0.1, 0, 0};
    }
    const SpaceHover hover(robot, scene_of({}), calm());
    const SpaceHoverAnalysis analysis = hover.at(place_of(robot, {0, 0, 2}, 0.5, 0.2));
    REQUIRE(analysis.verdict == HoldVerdict::stable);
    CHECK(analysis.trim.tilt_rad == Approx(0.1).epsilon(0.05));
    simulation::NoEffectInSpace nothing;
    const auto loop = simulation::make_space_loop({.robot = robot, .effect = nothing});
    loop->start(motion_at_rest(analysis.trim.reference));
    SpaceFlightRow row;
    for (int i = 0; i < 3000; ++i) {
        loop->quiet_tick(analysis.trim.reference, row);
    }
    CHECK(off(loop->motion(), analysis.trim.motion) < 1e-4);
}

TEST_CASE("Disturbances of a hover in space grow and decay in flight as fast as its eigenvalues say") {
    Random random(11);
    int growing = 0, decaying = 0;
    for (int round = 0; round < 48; ++round) {
        SpaceRobot robot = space_robot(round % 4);
        // A flight starts at the fixed point if the vehicle does not lean, and with rotors alike or without lag.
        for (SpaceRotor& rotor : robot.plant.rotors) {
            rotor.axis = {0, 0, 1};
        }
        robot.plant.time_constant_s = robot.joints() == 0 ? 0.03 : 0;
        robot.controller.delay_s = round % 5 == 0 ? 0.015 : 0;
        if (round % 7 == 4) {
            robot.controller.law = cascade_gains_for(robot.plant.time_constant_s, {});
        }
        const SpacePoint place = place_of(robot, {0, 0, 2}, 0, 0);
        const SpaceHover hover(robot, scene_of({}), calm());
        Slopes slopes(robot, {0, 0, 2}, random.uniform(0, round % 3 == 0 ? 0.5 : 12), random);
        const SpaceHoverAnalysis analysis = hover.at(place, slopes);
        REQUIRE(analysis.trim.limit == HoldLimit::none);
        const SpaceHoverStability& stability = analysis.stability;
        const double rate_1_s = stability.growth_rate_1_s;
        CAPTURE(round, rate_1_s, stability.frequency_rad_s, space_loop_name(stability.slowest_loop));
        const bool is_alone = stability.growing_modes <= (stability.frequency_rad_s > 0 ? 2 : 1);
        if (rate_1_s > 0.1 && rate_1_s < 8 && is_alone) {
            // An oscillation is measured over whole periods, late enough that other modes have
            // fallen behind; none of these grows.
            const double half_period_s =
                stability.frequency_rad_s > 0 ? std::numbers::pi / stability.frequency_rad_s : 0;
            const double least_s = 2 / rate_1_s;
            const double stretch_s = half_period_s > 0 ? half_period_s * std::ceil(least_s / half_period_s) : least_s;
            CHECK(flown_rate_1_s(robot, slopes, analysis.trim, 1e-8, 7 / rate_1_s, stretch_s) ==
                  Approx(rate_1_s).epsilon(0.03));
            ++growing;
        } else if (rate_1_s < -0.1) {
            // Many modes decay nearly as slowly: none decays more slowly than the slowest.
            constexpr double first_s = 5, last_s = 35;
            CHECK(flown_rate_1_s(robot, slopes, analysis.trim, 1e-5, first_s, 0.5 * (last_s - first_s)) <
                  rate_1_s + 2 / (last_s - first_s));
            ++decaying;
        }
    }
    CHECK(growing >= 5);
    CHECK(decaying >= 5);
}

TEST_CASE("Near surfaces, with models of several rotors, hovers grow in flight as fast as their eigenvalues say") {
    // Under the edge of a deck or over that of a block, at headings at which the images of neighbours differ.
    const auto scene =
        scene_of({{"deck", Box{{2, 4, 0.2}}, {-1, 0, 3.1}, {}}, {"block", Box{{4, 1, 1}}, {0, -0.5, 0.5}, {}}});
    AeroSettings aero;
    aero.ground = EffectModel::multirotor_body;
    aero.ceiling = EffectModel::multirotor_images;
    aero.tilt_loss = no_tilt_loss;
    Random random(5);
    int growing = 0;
    double by_attitude = 0;  // the greatest slope of the rolling or pitching torque [N m/rad]
    for (int round = 0; round < 60; ++round) {
        SpaceRobot robot = space_robot(round % 3);
        for (SpaceRotor& rotor : robot.plant.rotors) {
            rotor.axis = {0, 0, 1};
        }
        robot.plant.time_constant_s = robot.joints() == 0 ? 0.03 : 0;
        const bool is_under = round % 2 == 0;
        const Vector3 at_m{random.uniform(-0.35, 0.35), random.uniform(-0.35, 0.35),
                           is_under ? random.uniform(2.85, 2.89) : random.uniform(1.02, 1.1)};
        const double yaw_rad = random.uniform(-3, 3);
        const SpaceHover hover(robot, scene_of({}), aero);
        simulation::DirectSpaceEffect surfaces(scene, aero, robot);
        LessThanHere slopes(surfaces, robot, at_m, yaw_rad, random.uniform(2, 12));
        const SpaceHoverAnalysis analysis = hover.at(place_of(robot, at_m, yaw_rad, 0), slopes);
        REQUIRE(analysis.trim.limit == HoldLimit::none);
        const SpaceHoverStability& stability = analysis.stability;
        const double rate_1_s = stability.growth_rate_1_s;
        CAPTURE(round, rate_1_s, stability.frequency_rad_s, stability.growing_modes);
        by_attitude =
            std::max({by_attitude, std::abs(stability.roll_slope_nm_rad), std::abs(stability.pitch_slope_nm_rad)});
        const bool is_alone = stability.growing_modes <= (stability.frequency_rad_s > 0 ? 2 : 1);
        const double half_period_s = stability.frequency_rad_s > 0 ? std::numbers::pi / stability.frequency_rad_s : 0;
        // An oscillation is measured over halves of its period: K has to be smooth over what it grows to by then.
        constexpr double most_growth = 1.5;
        if (rate_1_s < 0.2 || rate_1_s > 8 || !is_alone || rate_1_s * half_period_s > most_growth) {
            continue;
        }
        const double least_s = 2 / rate_1_s;
        const double stretch_s = half_period_s > 0 ? half_period_s * std::ceil(least_s / half_period_s) : least_s;
        CHECK(flown_rate_1_s(robot, slopes, analysis.trim, 1e-8, 7 / rate_1_s, stretch_s,
                             simulation::space_aero(aero, robot.rotor_radius_m)) == Approx(rate_1_s).epsilon(0.03));
        ++growing;
    }
    CHECK(growing >= 3);
    CHECK(by_attitude > 0.5);
}

TEST_CASE("Under a wide ceiling the shipped planar robot in space hovers and falls as in the plane") {
    const Robot robot = shipped_robot_in_air();
    const SpaceRobot twin = twin_of(robot);
    const auto scene = scene_of({{"ceiling", Box{{40, 40, 1}}, {0, 0, ceiling_m + 0.5}, {}}});
    const FlightModel plane(robot, {}, scene, AeroSettings{});
    const SpaceHover space(twin, scene, AeroSettings{});
    int unstable = 0;
    for (const double gap_m : {0.065, 0.08, 0.1, 0.13, 0.2, 0.5}) {
        const HoverAnalysis expected = below_ceiling(plane, gap_m);
        const SpaceHoverAnalysis found =
            space.at(place_of(twin, {0, 0, ceiling_m - gap_m - hub_height_m}, 0, quarter_turn));
        CAPTURE(gap_m, space_loop_name(found.stability.slowest_loop));
        CHECK(found.verdict == expected.verdict);
        CHECK(found.trim.reference.position[space::z] == Approx(expected.trim.reference.position[1]).margin(1e-9));
        CHECK(found.trim.rotor_command_n[0] == Approx(expected.trim.rotor_command_n[0]).epsilon(1e-7));
        CHECK(found.stability.force_slope_n_m == Approx(expected.stability.force_slope_n_m).epsilon(1e-3));
        CHECK(found.stability.force_gain_n_m == Approx(expected.stability.force_gain_n_m).epsilon(1e-6));
        CHECK(found.stability.pitch_slope_nm_rad ==
              Approx(expected.stability.torque_slope_nm_rad).epsilon(1e-3).margin(1e-6));
        // What decays slowest may be a mode that the plane does not have.
        CHECK(found.stability.growth_rate_1_s > expected.stability.growth_rate_1_s - 1e-6);
        if (expected.verdict == HoldVerdict::unstable) {
            ++unstable;
            CHECK(found.stability.slowest_loop == space_loops::height);
            CHECK(found.stability.growth_rate_1_s == Approx(expected.stability.growth_rate_1_s).epsilon(1e-4));
        }
    }
    CHECK(unstable >= 2);
}

TEST_CASE("A rotor under a girder's edge and another beside it turn a hover, and flights tell which places hold") {
    SpaceRobot robot = space_robot(0);
    robot.plant.drag = {};
    const double flange_m = 4;  // its lower side
    const auto scene = scene_of({{"flange", Box{{20, 0.36, 0.03}}, {0, 0, flange_m + 0.015}, {}},
                                 {"web", Box{{20, 0.016, 1.37}}, {0, 0, flange_m + 0.715}, {}},
                                 {"deck", Box{{20, 20, 0.2}}, {0, 0, flange_m + 1.5}, {}}});
    const SpaceHover hover(robot, scene, AeroSettings{});
    const auto surfaces = hover.direct_effect();
    int stable = 0, unstable = 0;
    for (const double gap_m : {0.08, 0.12, 0.3}) {
        for (double y_m = 0; y_m < 0.6; y_m += 0.1) {
            const SpacePoint place = place_of(robot, {0, y_m, flange_m - gap_m - 0.05}, 0, 0);
            const SpaceHoverAnalysis analysis = hover.at(place, *surfaces);
            CAPTURE(gap_m, y_m, name_of(analysis.verdict), analysis.stability.growth_rate_1_s);
            if (analysis.verdict < HoldVerdict::unstable || std::abs(analysis.stability.growth_rate_1_s) < 0.05) {
                continue;
            }
            simulation::SpaceLoopSetup setup{.robot = robot,
                                             .effect = *surfaces,
                                             .aero = simulation::space_aero(AeroSettings{}, robot.rotor_radius_m)};
            const auto loop = simulation::make_space_loop(setup);
            loop->start(analysis.trim.motion);
            SpaceFlightRow row;
            double last_m = 0;
            bool is_lost = false;
            for (int i = 0; i < 3000 && !is_lost; ++i) {
                loop->quiet_tick(analysis.trim.reference, row);
                last_m = off(loop->motion(), analysis.trim.motion);
                is_lost = !(last_m < 0.3);
            }
            if (analysis.verdict == HoldVerdict::unstable) {
                ++unstable;
                CHECK((is_lost || last_m > 1e-3));
            } else {
                ++stable;
                CHECK(last_m < 1e-3);
            }
        }
    }
    CHECK(stable > 5);
    CAPTURE(unstable);
    // Off the middle of the flange the thrusts differ from side to side.
    const SpaceHoverAnalysis beside = hover.at(place_of(robot, {0, 0.25, flange_m - 0.2}, 0, 0), *surfaces);
    REQUIRE(beside.verdict >= HoldVerdict::unstable);
    const auto& command_n = beside.trim.rotor_command_n;
    CHECK(*std::max_element(command_n.begin(), command_n.begin() + 6) >
          *std::min_element(command_n.begin(), command_n.begin() + 6) + 0.05);
}

TEST_CASE("Hovers in space that cannot be have their reasons") {
    SpaceRobot robot = space_robot(1);
    const auto scene =
        scene_of({{"ceiling", Box{{20, 20, 1}}, {0, 0, 5.5}, {}}, {"floor", Box{{20, 20, 1}}, {0, 0, -0.5}, {}}});
    const auto at = [&](double z_m) {
        return SpaceHover(robot, scene, AeroSettings{}).at(place_of(robot, {0, 0, z_m}, 0, 0));
    };
    CHECK(at(4.93).verdict == HoldVerdict::not_flyable);
    robot.links[0].body.push_back({Capsule{0.02, {0, 0, 0}, {0, 0, -1}}, {}});
    CHECK(at(0.5).verdict == HoldVerdict::in_collision);
    robot.links[0].body.clear();
    CHECK(at(2.5).verdict == HoldVerdict::stable);
    robot.links[0].is_limited = true;
    robot.links[0].lower_limit_rad = 0.5;
    robot.links[0].upper_limit_rad = 1;
    CHECK(at(2.5).trim.limit == HoldLimit::arm_angle);
    robot.links[0].is_limited = false;
    std::fill(robot.max_thrust_n.begin(), robot.max_thrust_n.end(), 3.5);
    CHECK(at(2.5).trim.limit == HoldLimit::rotor_thrust);
    std::fill(robot.max_thrust_n.begin(), robot.max_thrust_n.end(), 12);
    robot.plant.links[0].center_of_mass_m = {0.1, 0, 0};
    robot.links[0].max_torque_nm = 0.01;
    CHECK(at(2.5).trim.limit == HoldLimit::joint_torque);
}

TEST_CASE("A hold map in space asks every node, on any number of threads") {
    const SpaceRobot robot = space_robot(1);
    const auto scene = scene_of({{"pipe", Cylinder{0.25, 8, {0, 1, 0}}, {0, 0, 3}, {}}});
    const SpaceHover hover(robot, scene, AeroSettings{});
    const SpacePoint pose = place_of(robot, {0, 0, 0}, 0.4, 0.2);
    const SpaceHoldMap map = make_space_hold_map(hover, {-0.5, 0, 2.2}, {0.5, 0, 2.9}, 0.1, pose, 3);
    REQUIRE(map.nodes == std::array<std::size_t, 3>{11, 1, 8});
    const SpaceHoldMap alone = make_space_hold_map(hover, {-0.5, 0, 2.2}, {0.5, 0, 2.9}, 0.1, pose, 1);
    int stable = 0, barred = 0;
    for (std::size_t i = 0; i < map.all.size(); ++i) {
        SpacePoint place = pose;
        const Vector3 at_m = map.place_m(i);
        std::copy(at_m.begin(), at_m.end(), place.position);
        const SpaceHoverAnalysis analysis = hover.at(place);
        CHECK(map.all[i].verdict == analysis.verdict);
        CHECK(map.all[i].verdict == alone.all[i].verdict);
        if (analysis.verdict >= HoldVerdict::unstable) {
            CHECK(map.all[i].growth_rate_1_s == alone.all[i].growth_rate_1_s);
            CHECK(map.all[i].growth_rate_1_s == analysis.stability.growth_rate_1_s);
        }
        stable += analysis.verdict == HoldVerdict::stable ? 1 : 0;
        barred += analysis.verdict == HoldVerdict::not_flyable ? 1 : 0;
    }
    CHECK(stable > 10);
    CHECK(barred > 5);
    CHECK_THROWS(make_space_hold_map(hover, {0, 0, 1}, {0, 0, 0}, 0.1, pose));
    CHECK_THROWS(make_space_hold_map(hover, {0, 0, 0}, {100, 100, 100}, 0.01, pose));
    CHECK_THROWS(make_space_hold_map(hover, {0, 0, 0}, {1, 1, 1}, 0, pose));
}
