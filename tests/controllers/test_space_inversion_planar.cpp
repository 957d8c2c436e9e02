#include <catch2/catch.hpp>
#include <vector>

#include "../support/random.hpp"
#include "downwash/controllers/aided_control.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/model_inversion_control.hpp"
#include "downwash/controllers/reference_segment.hpp"
#include "downwash/controllers/space_inversion_control.hpp"
#include "planar_twin.hpp"

// In the plane of motion the model inversion in space is the planar one.

using namespace downwash;
using namespace downwash::test;

namespace {

using Planar = dynamics::PlantState<double>;
using Space = dynamics::SpaceState<double, 1>;
using SpaceMemory = SpaceInversion::Memory<double, 1>;

constexpr double tick_s = 0.01;

/// A surface over part of the way: more thrust near z = 2, unequal along x. The same for both.
double ratio_at(double x_m, double z_m) {
    return 1 + 0.15 / (1 + 4 * (z_m - 2.4) * (z_m - 2.4)) / (1 + x_m * x_m);
}
const Ratios surface([](int /*rotor*/, double x_m, double z_m) { return ratio_at(x_m, z_m); });
const RatiosInSpace surface_in_space([](int /*rotor*/, double x_m, double /*y_m*/, double z_m) {
    return ratio_at(x_m, z_m);
});

/// What the law in space reads.
struct SurfaceMap {
    [[nodiscard]] double ratio(int /*rotor*/, const dynamics::LaneVector<double>& hub_m) const {
        return ratio_at(hub_m.x, hub_m.z);
    }
};

/// A plan of 20 s from rest to rest by way of points in motion.
ReferencePoint reference_at(std::int64_t tick) {
    static const auto legs = [] {
        ReferencePoint between = at_rest({1.5, 2.3, 0.3});
        between.velocity[0] = 0.7;
        between.velocity[2] = -0.4;
        const ReferencePoint points[] = {at_rest({0, 1.5, 1.2}), between, at_rest({0.4, 1.2, -1}),
                                         at_rest({0.2, 2.2, 1.57})};
        std::vector<ReferenceSegment> all;
        for (int i = 0; i < 3; ++i) {
            all.emplace_back(points[i], points[i + 1], 500, tick_s);
        }
        return all;
    }();
    const std::size_t leg = static_cast<std::size_t>(std::min<std::int64_t>(tick / 500, 2));
    return legs[leg].at_tick(std::min<std::int64_t>(tick - 500 * static_cast<std::int64_t>(leg), 500));
}

struct Difference {
    double place_m = 0, angle_rad = 0, command_n = 0, torque_nm = 0;
    double max_saturation = 0;
    double way_m = 0;
};

/// Flies the same reference with both laws for 20 s, each with its own plant.
Difference difference_of(const Robot& robot, int delay_ticks) {
    const PlantModel plane = plant_of(robot);
    const SpaceLawModel<1> space = law_model_of(robot);
    const ModelInversion& law = gains_of(robot);
    const SpaceInversion in_space_law = from_planar(law);
    const controllers::Aided<ModelInversion> aided{law};

    Planar planar{};
    planar.q[1] = 1.5;
    planar.q[3] = 1.2;
    std::fill(planar.thrust_n, planar.thrust_n + 4, plane.weight_n / 4);
    Space other = lifted(planar);
    auto memory = aided.rested(plane, planar, tick_s);
    auto other_memory = in_space_law.rested(space, other, tick_s);
    std::vector<Planar> past(static_cast<std::size_t>(delay_ticks + 1), planar);
    std::vector<Space> other_past(past.size(), other);
    Difference worst;
    for (std::int64_t tick = 0; tick < 2000; ++tick) {
        const ReferencePoint reference = reference_at(tick);
        Planar seen = past.back();
        Space other_seen = other_past.back();
        std::copy(planar.thrust_n, planar.thrust_n + 4, seen.thrust_n);
        std::copy(other.thrust_n, other.thrust_n + 4, other_seen.thrust_n);
        controllers::Actuation<double> given;
        memory = aided.control(plane, seen, dynamics::motion_at(plane, seen.q, seen.u), memory, reference, tick_s,
                               given, surface);
        dynamics::SpaceCommand<double, 1> other_given;
        SpaceMemory next;
        const double saturation = in_space_law.control(space, other_seen, other_memory, lifted(reference), tick_s,
                                                       SurfaceMap{}, other_given, next);
        other_memory = next;
        planar = dynamics::flight_step(plane, planar, given.command, tick_s, surface);
        other = dynamics::space_step(space.plant, other, other_given, tick_s, surface_in_space);
        std::rotate(past.rbegin(), past.rbegin() + 1, past.rend());
        std::rotate(other_past.rbegin(), other_past.rbegin() + 1, other_past.rend());
        past.front() = planar;
        other_past.front() = other;

        worst.max_saturation = std::max(worst.max_saturation, saturation);
        worst.place_m = std::max({worst.place_m, std::abs(other.q[0] - planar.q[0]), std::abs(other.q[1]),
                                  std::abs(other.q[2] - planar.q[1])});
        worst.angle_rad = std::max({worst.angle_rad, std::abs(2 * std::atan2(other.q[5], other.q[3]) - planar.q[2]),
                                    std::abs(other.q[4]), std::abs(other.q[6]), std::abs(other.q[7] - planar.q[3])});
        worst.torque_nm =
            std::max(worst.torque_nm, std::abs(other_given.joint_torque_nm[0] - given.command.joint_torque_nm));
        for (int i = 0; i < 4; ++i) {
            worst.command_n = std::max(worst.command_n, std::abs(other_given.thrust_n[i] - given.command.thrust_n[i]));
        }
        worst.way_m = std::max(worst.way_m, std::abs(planar.q[0]));
    }
    return worst;
}

}  // namespace

TEST_CASE("The shipped robot flies a planar reference in space as in the plane, to 1e-6 m over 20 s") {
    for (const int delay_ticks : {0, 1}) {
        for (const bool with_map : {false, true}) {
            for (const bool with_observer : {false, true}) {
                Robot robot = shipped_robot();
                if (with_map) {
                    gains_of(robot).aids.feed_forward = controllers::FeedForward{0.03, -0.02};
                }
                if (!with_observer) {
                    gains_of(robot).aids.observer.reset();
                }
                const Difference found = difference_of(robot, delay_ticks);
                CAPTURE(delay_ticks, with_map, with_observer, found.place_m, found.angle_rad, found.command_n,
                        found.torque_nm, found.max_saturation);
                CHECK(found.way_m > 1);
                CHECK(found.place_m < 1e-6);
                CHECK(found.angle_rad < 1e-6);
                CHECK(found.max_saturation < 1);
            }
        }
    }
}

TEST_CASE("At any planar state the law in space commands what the planar one does") {
    Random random(1);
    Robot robot = shipped_robot();
    robot.arm.joint_x_m = 0.1;
    robot.arm.joint_z_m = -0.07;
    gains_of(robot).attitude_rate_kp = 5;
    double worst = 0;
    int within = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        ModelInversion& law = gains_of(robot);
        law.rate_feed_forward = trial % 2 == 0;
        law.aids = {};
        if (trial % 3 > 0) {
            law.aids.observer = controllers::DisturbanceObserver{random.uniform(1, 10)};
        }
        if (trial % 5 > 1) {
            law.aids.feed_forward = controllers::FeedForward{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
        }
        const PlantModel plane = plant_of(robot);
        const SpaceLawModel<1> space = law_model_of(robot);
        const controllers::Aided<ModelInversion> aided{law};
        Planar planar{};
        ReferencePoint reference;
        for (int i = 0; i < 4; ++i) {
            planar.q[i] = random.uniform(-0.5, 0.5);
            planar.u[i] = random.uniform(-0.5, 0.5);
            // Left as right: the plane knows no other.
            planar.thrust_n[i] = i % 2 == 0 ? random.uniform(10, 15) : planar.thrust_n[i - 1];
        }
        for (int i = 0; i < 3; ++i) {
            reference.position[i] = planar.q[i == 2 ? 3 : i] + random.uniform(-0.3, 0.3);
            reference.velocity[i] = random.uniform(-0.5, 0.5);
            reference.acceleration[i] = random.uniform(-0.5, 0.5);
        }
        // A memory that both can have: after one tick elsewhere.
        Planar before = planar;
        before.q[2] += random.uniform(-0.02, 0.02);
        before.u[0] += random.uniform(-0.1, 0.1);
        auto memory = aided.rested(plane, before, tick_s);
        const SpaceInversion other_law = from_planar(law);
        auto other_memory = other_law.rested(space, lifted(before), tick_s);
        memory.loops.position_integral[0] = other_memory.position_integral[0] = random.uniform(-1, 1);
        memory.loops.position_integral[1] = other_memory.position_integral[2] = random.uniform(-0.5, 0.5);
        memory.loops.pitch_rate_integral = other_memory.rate_integral[1] = random.uniform(-0.1, 0.1);
        memory.loops.arm_integral = other_memory.joint_integral[0] = random.uniform(-0.3, 0.3);
        memory.loops.pitch_reference_rate = other_memory.direction_rate[1] = random.uniform(-0.3, 0.3);
        memory.loops.rate_reference = other_memory.rate_reference[1] = random.uniform(-0.3, 0.3);
        controllers::Actuation<double> given;
        dynamics::SpaceCommand<double, 1> other_given;
        SpaceMemory next;
        memory = aided.control(plane, planar, dynamics::motion_at(plane, planar.q, planar.u), memory, reference, tick_s,
                               given, surface);
        const double saturation = other_law.control(space, lifted(planar), other_memory, lifted(reference), tick_s,
                                                    SurfaceMap{}, other_given, next);
        CHECK((saturation > 1) == (given.saturation > 1));
        if (given.saturation > 1) {
            continue;  // the plane clips each rotor for itself
        }
        CHECK(saturation == Approx(given.saturation).epsilon(1e-9));
        ++within;
        worst = std::max(worst, std::abs(given.command.joint_torque_nm - other_given.joint_torque_nm[0]));
        for (int i = 0; i < 4; ++i) {
            worst = std::max(worst, std::abs(given.command.thrust_n[i] - other_given.thrust_n[i]));
        }
        worst = std::max({worst, std::abs(memory.loops.position_integral[0] - next.position_integral[0]),
                          std::abs(memory.loops.position_integral[1] - next.position_integral[2]),
                          std::abs(memory.loops.pitch_rate_integral - next.rate_integral[1]),
                          std::abs(memory.loops.arm_integral - next.joint_integral[0]),
                          std::abs(memory.loops.pitch_reference_rate - next.direction_rate[1]),
                          std::abs(memory.loops.rate_reference - next.rate_reference[1])});
        const int planar_of[] = {0, -1, 1, -1, 2, -1, 3};
        for (int i = 0; i < 7; ++i) {
            worst = std::max(worst,
                             std::abs(next.observed[i] - (planar_of[i] < 0 ? 0 : memory.observed[planar_of[i]])) / 100);
        }
    }
    CHECK(within > 500);
    CHECK(worst < 1e-9);
}
