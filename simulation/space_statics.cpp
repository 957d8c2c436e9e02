#include "downwash/simulation/space_statics.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/dynamics/plant_model.hpp"

namespace downwash {
namespace {

Vector3 normalised(const Vector3& v) {
    return (1 / std::sqrt(dot(v, v))) * v;
}

/// Columns are the axes of a link in the multirotor's frame.
Eigen::Matrix3d turned(const Eigen::Matrix3d& frame, const Vector3& axis, double angle_rad) {
    return frame * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(axis.data())).toRotationMatrix();
}

Vector3 in_body(const Eigen::Matrix3d& frame, const Vector3& v) {
    const Eigen::Vector3d product = frame * Eigen::Vector3d(v.data());
    return {product[0], product[1], product[2]};
}

/// Thrust along the body's z and the three torques of each rotor at 1 N, about the multirotor's centre of mass.
Eigen::Matrix4Xd effectiveness(const SpacePlant& plant) {
    Eigen::Matrix4Xd b(4, static_cast<Eigen::Index>(plant.rotors.size()));
    for (std::size_t k = 0; k < plant.rotors.size(); ++k) {
        const SpaceRotor& rotor = plant.rotors[k];
        const Vector3 axis = normalised(rotor.axis);
        // What drives a rotor counterclockwise turns the body clockwise.
        const Vector3 torque = cross(rotor.position_m, axis) + (-rotor.spin * rotor.drag_torque_m) * axis;
        b.col(static_cast<Eigen::Index>(k)) << axis[2], torque[0], torque[1], torque[2];
    }
    return b;
}

constexpr double least_share = 1e-6;  // of the largest singular value: less is rounding

double lowest(const SpaceLinkLimits& link) {
    return link.is_limited ? link.lower_limit_rad : -std::numbers::pi;
}
double highest(const SpaceLinkLimits& link) {
    return link.is_limited ? link.upper_limit_rad : std::numbers::pi;
}

}  // namespace

ArmPose arm_pose(const SpaceRobot& robot, const std::vector<double>& joints_rad) {
    ArmPose pose;
    Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
    Vector3 at_m{};
    for (std::vector<Vector3>* rows : {&pose.joint_m, &pose.axis, &pose.center_of_mass_m}) {
        rows->reserve(robot.plant.links.size());
    }
    for (std::size_t i = 0; i < robot.plant.links.size(); ++i) {
        const SpaceLink& link = robot.plant.links[i];
        const Vector3 axis = normalised(link.axis);
        at_m = at_m + in_body(frame, link.joint_m);
        pose.joint_m.push_back(at_m);
        pose.axis.push_back(in_body(frame, axis));
        frame = turned(frame, axis, joints_rad[i]);
        pose.center_of_mass_m.push_back(at_m + in_body(frame, link.center_of_mass_m));
    }
    pose.end_effector_m = at_m + in_body(frame, robot.plant.end_effector_m);
    pose.direction = in_body(frame, normalised(robot.tool_direction));
    return pose;
}

Vector3 center_of_mass_m(const SpaceRobot& robot, const ArmPose& pose) {
    Vector3 moment{};
    for (std::size_t i = 0; i < robot.plant.links.size(); ++i) {
        moment = moment + robot.plant.links[i].body.mass_kg * pose.center_of_mass_m[i];
    }
    return (1 / robot.mass_kg()) * moment;
}

double holding_torque_nm(const SpaceRobot& robot, const ArmPose& pose, std::size_t joint) {
    double torque_nm = 0;
    for (std::size_t i = joint; i < robot.plant.links.size(); ++i) {
        const Vector3 weight_n{0, 0, -robot.plant.links[i].body.mass_kg * standard_gravity_m_s2};
        torque_nm -= dot(pose.axis[joint], cross(pose.center_of_mass_m[i] - pose.joint_m[joint], weight_n));
    }
    return torque_nm;
}

std::vector<double> thrust_shares(const SpacePlant& plant, const Vector3& at_m) {
    if (allocation_rank(plant, true) < 4) {
        return {};
    }
    const Eigen::Matrix4Xd b = effectiveness(plant);
    const Eigen::VectorXd shares =
        b.transpose() * (b * b.transpose()).ldlt().solve(Eigen::Vector4d(1, at_m[1], -at_m[0], 0));
    return {shares.begin(), shares.end()};
}

int allocation_rank(const SpacePlant& plant, bool with_yaw) {
    Eigen::MatrixXd b = effectiveness(plant).topRows(with_yaw ? 4 : 3);
    for (Eigen::Index row = 0; row < b.rows(); ++row) {
        const double length = b.row(row).norm();
        if (length > 0) {
            b.row(row) /= length;
        }
    }
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(b).singularValues();
    return static_cast<int>(
        std::count_if(values.begin(), values.end(), [&](double value) { return value > least_share * values[0]; }));
}

Vector3 principal_moments(const Matrix3& inertia) {
    Eigen::Matrix3d m;
    for (int row = 0; row < 3; ++row) {
        m.row(row) = Eigen::RowVector3d(inertia[static_cast<std::size_t>(row)].data());
    }
    const Eigen::Vector3d moments =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues();
    return {moments[0], moments[1], moments[2]};
}

WorstPose worst_pose(const SpaceRobot& robot, const std::function<double(const std::vector<double>&)>& value) {
    const std::size_t joints = robot.links.size();
    WorstPose worst;
    constexpr int starts = 32, most_sweeps = 50;
    for (int start = 0; start < (joints == 0 ? 1 : starts); ++start) {
        std::vector<double> q(joints);
        for (std::size_t i = 0; i < joints; ++i) {
            // Multiples of different irrational numbers: poses that fill the space of joints evenly.
            const double turns = (start + 0.5) * std::sqrt(2.0 + 3.0 * static_cast<double>(i));
            q[i] = lowest(robot.links[i]) +
                   (turns - std::floor(turns)) * (highest(robot.links[i]) - lowest(robot.links[i]));
        }
        double best = value(q);
        for (int sweep = 0; sweep < most_sweeps; ++sweep) {
            const double before = best;
            for (std::size_t i = 0; i < joints; ++i) {
                const auto at = [&](double angle_rad) {
                    const double kept_rad = std::exchange(q[i], angle_rad);
                    const double found = value(q);
                    q[i] = kept_rad;
                    return found;
                };
                const double forth = at(0), back = at(std::numbers::pi), middle = (forth + back) / 2;
                const double peak = std::atan2(at(std::numbers::pi / 2) - middle, (forth - back) / 2);
                const double low = lowest(robot.links[i]), high = highest(robot.links[i]);
                const double turn = 2 * std::numbers::pi;
                const double first = peak + turn * std::ceil((low - peak) / turn);
                for (const double angle_rad : {low, high, first}) {
                    if (angle_rad > high) {
                        continue;
                    }
                    if (const double there = at(angle_rad); there > best) {
                        q[i] = angle_rad;
                        best = there;
                    }
                }
            }
            if (best <= before + 1e-12 * std::abs(before)) {
                break;
            }
        }
        if (start == 0 || best > worst.value) {
            worst = {best, q};
        }
    }
    return worst;
}

double arm_reach_m(const SpaceRobot& robot) {
    return std::sqrt(worst_pose(robot, [&](const std::vector<double>& joints_rad) {
                         const Vector3 end_m = arm_pose(robot, joints_rad).end_effector_m;
                         return dot(end_m, end_m);
                     }).value);
}

std::string joints_text(const std::vector<double>& joints_rad) {
    constexpr double tenths = 10;
    return "[" +
           joined(joints_rad, ", ",
                  [](double rad) {
                      return to_text(std::round(rad * degrees_per_radian * tenths) / tenths + 0.0);  // no -0
                  }) +
           "]";
}

}  // namespace downwash
