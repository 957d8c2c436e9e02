#include "downwash/simulation/space_press.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <variant>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/direction.hpp"
#include "downwash/base/text.hpp"
#include "downwash/simulation/space_statics.hpp"
#include "downwash/simulation/space_tool.hpp"
#include "downwash/simulation/space_touch_place.hpp"

namespace downwash {
namespace {

std::string text(double value) {
    return to_text(value, 3);
}

/// What the rotors lack to carry the weight and a force on the robot at a place, both in the multirotor's frame.
std::string rotors_lack(const SpaceRobot& robot, const Vector3& center_m, const Vector3& force_n, const Vector3& at_m) {
    const double weight_n = robot.mass_kg() * standard_gravity_m_s2;
    const Vector3 thrust_n = Vector3{0, 0, weight_n} - force_n;
    const double size_n = length_of(thrust_n);
    const double most_n = std::accumulate(robot.max_thrust_n.begin(), robot.max_thrust_n.end(), 0.0);
    if (size_n > most_n) {
        return "takes " + text(size_n) + " N of thrust, and its rotors give " + text(most_n) + " N at most";
    }
    const double tilt_rad = std::acos(std::clamp(thrust_n[2] / size_n, -1.0, 1.0));
    const double most_rad =
        std::visit([](const auto& law) -> double { return law.max_tilt_rad; }, robot.controller.law);
    if (tilt_rad > most_rad) {
        return "takes a tilt of " + text(tilt_rad * degrees_per_radian) + " degrees, and its controller allows " +
               text(most_rad * degrees_per_radian);
    }
    // The line along which the thrust acts, so that it balances the moments of weight and force.
    const Vector3 moment_nm = cross(center_m, Vector3{0, 0, weight_n}) - cross(at_m, force_n);
    const std::vector<double> shares = thrust_shares(robot.plant, {-moment_nm[1] / size_n, moment_nm[0] / size_n, 0});
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double rotor_n = shares[i] * size_n;
        if (rotor_n > robot.max_thrust_n[i] || rotor_n < robot.min_thrust_n[i]) {
            return "takes " + text(rotor_n) + " N of rotor " + std::to_string(i + 1) + ", which gives " +
                   text(robot.min_thrust_n[i]) + " to " + text(robot.max_thrust_n[i]) + " N";
        }
    }
    return "";
}

std::string joints_lack(const SpaceRobot& robot, const ArmPose& arm, const Vector3& force_n, const Vector3& at_m) {
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const double torque_nm =
            std::abs(holding_torque_nm(robot, arm, i) - dot(arm.axis[i], cross(at_m - arm.joint_m[i], force_n)));
        if (torque_nm > robot.links[i].max_torque_nm) {
            return "takes " + text(torque_nm) + " N m of joint " + std::to_string(i + 1) + ", which gives " +
                   text(robot.links[i].max_torque_nm) + " N m at most";
        }
    }
    return "";
}

}  // namespace

std::string lacks_to_press(const SpaceRobot& robot, const SpacePose& waiting, const SpaceTouch& touch) {
    const Matrix3 axes = rotation_of(waiting.attitude);
    const auto in_frame = [&axes](const Vector3& v) {
        Vector3 out{};
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t column = 0; column < 3; ++column) {
                out[column] += axes[row][column] * v[row];
            }
        }
        return out;
    };
    const ArmPose arm = arm_pose(robot, {waiting.joints_rad.begin(), waiting.joints_rad.begin() + robot.joints()});
    const Vector3 force_n = in_frame(touch.force_n * touch.normal);
    const Vector3 at_m = in_frame(middle_of(touch, robot, waiting) - waiting.position_m);
    std::string lack = rotors_lack(robot, center_of_mass_m(robot, arm), force_n, at_m);
    if (lack.empty() && touch.part == TouchingPart::end_effector) {
        lack = joints_lack(robot, arm, force_n, at_m);
    }
    return lack;
}

}  // namespace downwash
