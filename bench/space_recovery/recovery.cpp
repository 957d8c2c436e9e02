#include "recovery.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "downwash/controllers/space_gains.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::bench {
namespace {

constexpr double degree = std::numbers::pi / 180;

double length(const Vector3& v) {
    return std::sqrt(dot(v, v));
}

/// Masses of the whole vehicle with its joints at zero, where the axes of all links are those of the body.
struct WholeBody {
    Vector3 center_m{};
    Vector3 inertia_kg_m2{};  ///< about it, about each body axis
};

WholeBody whole_body(const SpacePlant& plant) {
    double mass_kg = 0;
    Vector3 moment{}, inertia{};
    const auto add = [&](const SpaceBody& body, const Vector3& at_m) {
        mass_kg += body.mass_kg;
        moment = moment + body.mass_kg * at_m;
        for (std::size_t i = 0; i < 3; ++i) {
            inertia[i] += body.inertia_kg_m2[i][i] + body.mass_kg * (dot(at_m, at_m) - at_m[i] * at_m[i]);
        }
    };
    add(plant.multirotor, {});
    Vector3 joint_m{};
    for (const SpaceLink& link : plant.links) {
        joint_m = joint_m + link.joint_m;
        add(link.body, joint_m + link.center_of_mass_m);
    }
    WholeBody whole{1 / mass_kg * moment, inertia};
    const Vector3& c = whole.center_m;
    for (std::size_t i = 0; i < 3; ++i) {
        whole.inertia_kg_m2[i] -= mass_kg * (dot(c, c) - c[i] * c[i]);
    }
    return whole;
}

/// The greatest torque about each body axis through a point, in the direction in which there is less.
Vector3 greatest_torques_nm(const SpaceRobot& robot, const Vector3& about_m) {
    Vector3 forward{}, backward{};
    for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
        const SpaceRotor& rotor = robot.plant.rotors[k];
        const Vector3 axis = 1 / length(rotor.axis) * rotor.axis;
        const Vector3 lever_m = rotor.position_m - about_m;
        // The drag of a rotor that spins counterclockwise turns the vehicle clockwise.
        const Vector3 per_n = cross(lever_m, axis) - rotor.spin * rotor.drag_torque_m * axis;
        for (std::size_t i = 0; i < 3; ++i) {
            const double least = per_n[i] * robot.min_thrust_n[k], most = per_n[i] * robot.max_thrust_n[k];
            forward[i] += std::max(least, most);
            backward[i] -= std::min(least, most);
        }
    }
    return {std::min(forward[0], backward[0]), std::min(forward[1], backward[1]), std::min(forward[2], backward[2])};
}

/// Cosine of the tilt.
double upward(const SpaceMotion& motion) {
    const std::array<double, 4>& q = motion.attitude;
    return 1 - 2 * (q[1] * q[1] + q[2] * q[2]);
}

bool is_upright(const SpaceMotion& motion) {
    const Vector3& rates = motion.body_rates_rad_s;
    return upward(motion) > std::cos(60 * degree) && motion.velocity_m_s[2] > -2 &&
           std::max({std::abs(rates[0]), std::abs(rates[1]), std::abs(rates[2])}) < 2;
}

bool is_home(const SpaceMotion& motion) {
    return length(motion.position_m) < 0.1 && length(motion.velocity_m_s) < 0.1 &&
           length(motion.body_rates_rad_s) < 0.1 && upward(motion) > std::cos(2 * degree);
}

double beyond_limits_rad(const SpaceRobot& robot, const SpaceMotion& motion) {
    double most = 0;
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const SpaceLinkLimits& link = robot.links[i];
        if (link.is_limited) {
            most = std::max(
                {most, link.lower_limit_rad - motion.joints_rad[i], motion.joints_rad[i] - link.upper_limit_rad});
        }
    }
    return most;
}

}  // namespace

SpaceRobot without_arm(SpaceRobot robot) {
    robot.plant.links.clear();
    robot.links.clear();
    return robot;
}

SpaceRobot with_thrust_over_weight(SpaceRobot robot, double ratio) {
    double lift_n = 0;
    for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
        const Vector3& axis = robot.plant.rotors[k].axis;
        lift_n += robot.max_thrust_n[k] * axis[2] / length(axis);
    }
    const double scale = ratio * robot.mass_kg() * standard_gravity_m_s2 / lift_n;
    for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
        robot.min_thrust_n[k] *= scale;
        robot.max_thrust_n[k] *= scale;
    }
    return robot;
}

SpaceRobot under_cascade(SpaceRobot robot) {
    robot.controller.law = cascade_gains_for(robot.plant.time_constant_s, {});
    return robot;
}

Vector3 stoppable_rates_rad_s(const SpaceRobot& robot) {
    const WholeBody whole = whole_body(robot.plant);
    const Vector3 torque_nm = greatest_torques_nm(robot, whole.center_m);
    const double late_s = 1 / robot.controller.rate_hz + robot.controller.delay_s + robot.plant.time_constant_s;
    Vector3 rates{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double a = whole.inertia_kg_m2[i] / (2 * torque_nm[i]);
        rates[i] = (std::sqrt(late_s * late_s + 4 * a * std::numbers::pi) - late_s) / (2 * a);
    }
    return rates;
}

Throw drawn_throw(const Vector3& stoppable_rad_s, double max_effort, test::Random& random) {
    Throw thrown;
    std::array<double, 4>& attitude = thrown.motion.attitude;
    double size = 0;
    do {  // four numbers in the ball
        size = 0;
        for (double& number : attitude) {
            number = random.uniform(-1, 1);
            size += number * number;
        }
    } while (size > 1 || size < 1e-4);
    for (double& number : attitude) {
        number /= std::sqrt(size);
    }
    Vector3 way{};
    do {
        way = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    } while (length(way) > 1 || length(way) < 1e-2);
    thrown.effort = random.uniform(0, max_effort);
    for (std::size_t i = 0; i < 3; ++i) {
        thrown.motion.body_rates_rad_s[i] = thrown.effort * way[i] / length(way) * stoppable_rad_s[i];
        thrown.motion.velocity_m_s[i] = random.uniform(-1, 1);
    }
    return thrown;
}

Recovery recover(const SpaceRobot& robot, const SpaceMotion& thrown) {
    simulation::NoEffectInSpace free_air;
    const auto loop = simulation::make_space_loop({robot, {}, free_air, {}, false});
    loop->start(thrown);
    const double tick_s = 1 / robot.controller.rate_hz;
    const std::int64_t second = std::llround(robot.controller.rate_hz);
    const std::int64_t last = std::llround(max_recovery_s * robot.controller.rate_hz);
    Recovery recovery;
    std::int64_t tick = 0, upright_ticks = 0, home_ticks = 0, first_upright = last;
    for (; tick < last && home_ticks < second && loop->is_within(max_state); ++tick) {
        SpaceFlightRow row;
        loop->tick(tick, {}, row);
        recovery.end = loop->motion();
        recovery.height_lost_m = std::max(recovery.height_lost_m, -recovery.end.position_m[2]);
        recovery.joint_beyond_rad = std::max(recovery.joint_beyond_rad, beyond_limits_rad(robot, recovery.end));
        upright_ticks = is_upright(recovery.end) ? upright_ticks + 1 : 0;
        home_ticks = is_home(recovery.end) ? home_ticks + 1 : 0;
        if (upright_ticks == second) {
            first_upright = std::min(first_upright, tick + 1 - second);
        }
    }
    recovery.is_upright = upright_ticks >= second;
    recovery.is_home = home_ticks >= second;
    recovery.upright_s = static_cast<double>(std::min(first_upright, tick)) * tick_s;
    recovery.home_s = static_cast<double>(recovery.is_home ? tick - second : tick) * tick_s;
    return recovery;
}

}  // namespace downwash::bench
