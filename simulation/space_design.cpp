#include "downwash/simulation/space_design.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <numbers>

#include "downwash/base/infinity.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/space_hover.hpp"

namespace downwash {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d vector_of(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

Matrix3d matrix_of(const Matrix3& m) {
    Matrix3d out;
    out << m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1], m[2][2];
    return out;
}

/// The mass matrix in the multirotor's frame: its linear and angular acceleration, then the joints.
MatrixXd mass_matrix(const SpacePlant& plant, const std::vector<double>& joints_rad) {
    const auto count = static_cast<Eigen::Index>(plant.links.size());
    MatrixXd mass = MatrixXd::Zero(6 + count, 6 + count);
    // Of each body: how its centre of mass moves, and how it turns.
    MatrixXd moves = MatrixXd::Zero(3, 6 + count), turns = MatrixXd::Zero(3, 6 + count);
    const auto add = [&](const SpaceBody& body, const Matrix3d& frame) {
        mass += body.mass_kg * moves.transpose() * moves +
                turns.transpose() * (frame * matrix_of(body.inertia_kg_m2) * frame.transpose()) * turns;
    };
    moves.leftCols<3>().setIdentity();
    turns.middleCols<3>(3).setIdentity();
    Matrix3d frame = Matrix3d::Identity();
    add(plant.multirotor, frame);
    const MatrixXd origin_moves = moves;
    std::vector<Vector3d> joint_m, axis;
    Vector3d at_m = Vector3d::Zero();
    for (Eigen::Index i = 0; i < count; ++i) {
        const SpaceLink& link = plant.links[static_cast<std::size_t>(i)];
        at_m += frame * vector_of(link.joint_m);
        joint_m.push_back(at_m);
        axis.push_back(frame * vector_of(link.axis).normalized());
        frame *= Eigen::AngleAxisd(joints_rad[static_cast<std::size_t>(i)], vector_of(link.axis).normalized())
                     .toRotationMatrix();
        const Vector3d center_m = at_m + frame * vector_of(link.center_of_mass_m);
        moves = origin_moves;
        for (Eigen::Index k = 0; k < 3; ++k) {
            moves.col(3 + k) = Vector3d::Unit(k).cross(center_m);
        }
        for (Eigen::Index k = 0; k <= i; ++k) {
            const auto j = static_cast<std::size_t>(k);
            moves.col(6 + k) = axis[j].cross(center_m - joint_m[j]);
            turns.col(6 + k) = axis[j];
        }
        add(link.body, frame);
    }
    return mass;
}

/// The torques that keep the joints from accelerating while a wrench acts on the multirotor and nothing weighs.
VectorXd holding_nm(const MatrixXd& mass, const VectorXd& wrench) {
    return mass.bottomLeftCorner(mass.rows() - 6, 6) * mass.topLeftCorner<6, 6>().ldlt().solve(wrench);
}

/// Gains of the disturbance observer over the frequency of the joints: a faster observer holds the same arm with slower
/// joints. The first that leaves enough to every joint is taken.
constexpr double observer_shares[] = {0.5, 1, 1.5, 2, 3};
/// Of the stiffness that the arm asks for. Where the delay does not allow all of it, less leaves more to both sides.
constexpr double stiffness_parts[] = {1, 0.7};

/// The stiffness that is left to hold an arm, over the square of the joints' frequency w, with an observer of c w.
/// Both make w^2 (1 + 2 c). What integrates takes 2 c / (2 + c) of it at half the gain, and the delay 0.2 c.
double stiffness_share(double c) {
    return 1 + 2 * c - 2 * c / (2 + c) - 0.2 * c;
}

SpaceInversion law_for(const SpaceRobot& robot, const SpaceBandwidths& bandwidths) {
    SpaceInversion law = gains_for(robot.plant.time_constant_s, bandwidths);
    if (law.observer_gain_1_s > 0) {
        law.joint.ki_1_s3 = 0;
    }
    return law;
}

/// The least margin of a joint in the examined poses over 6 dB or 30 deg; infinite without joints, 0 where the robot
/// cannot hover in one of them.
double part_of_margins(SpaceRobot robot, const SpaceInversion& law) {
    constexpr double enough_db = 6, enough_rad = std::numbers::pi / 6;
    robot.controller.law = law;
    double part = infinity;
    if (!space_robot_errors(robot).empty()) {
        return part;  // which its reader reports
    }
    try {
        for (const ExaminedPose& pose : examined_poses(robot)) {
            const std::vector<LoopMargins> loops = space_loop_margins(robot, pose.joints_rad).loops;
            for (std::size_t loop = space_loops::first_joint; loop < loops.size(); ++loop) {
                part =
                    std::min({part, loops[loop].gain_margin_db / enough_db, loops[loop].phase_margin_rad / enough_rad});
            }
        }
    } catch (const InputError&) {
        return 0;
    }
    return part;
}

double lowest(const SpaceLinkLimits& link) {
    return link.is_limited ? link.lower_limit_rad : -std::numbers::pi;
}
double highest(const SpaceLinkLimits& link) {
    return link.is_limited ? link.upper_limit_rad : std::numbers::pi;
}

/// Visits 512 poses that are spread evenly over the limits of the joints, and all in which every joint is in its middle
/// or at an end. None without joints.
void for_each_pose(const SpaceRobot& robot, const std::function<void(const std::vector<double>& joints_rad)>& visit) {
    const std::size_t count = robot.links.size();
    constexpr int poses = 512;
    for (int pose = 0; pose < (count == 0 ? 0 : poses); ++pose) {
        std::vector<double> q;
        for (std::size_t i = 0; i < count; ++i) {
            // Multiples of different irrational numbers fill the space of joints evenly.
            const double turns = (pose + 0.5) * std::sqrt(2.0 + 3.0 * static_cast<double>(i));
            q.push_back(std::lerp(lowest(robot.links[i]), highest(robot.links[i]), turns - std::floor(turns)));
        }
        visit(q);
    }
    // Arms hang and stand straight at round angles.
    std::vector<std::size_t> which(count);
    for (bool is_over = count == 0; !is_over;) {
        std::vector<double> q;
        for (std::size_t i = 0; i < count; ++i) {
            const double low = lowest(robot.links[i]), high = highest(robot.links[i]);
            const double angles[] = {low, std::clamp(0.0, low, high), high};
            q.push_back(angles[which[i]]);
        }
        visit(q);
        std::size_t i = 0;
        while (i < count && ++which[i] == 3) {
            which[i++] = 0;
        }
        is_over = i == count;
    }
}

}  // namespace

double joint_stiffness_asked_1_s2(const SpaceRobot& robot, const std::vector<double>& joints_rad) {
    const auto count = static_cast<Eigen::Index>(joints_rad.size());
    if (count == 0) {
        return 0;
    }
    const MatrixXd mass = mass_matrix(robot.plant, joints_rad);
    // Seen from a frame that falls freely nothing weighs, and the robot accelerates upwards by g.
    const VectorXd carrying = mass.topLeftCorner<6, 6>().col(2) * standard_gravity_m_s2;
    constexpr double step_rad = 1e-5;
    MatrixXd slope(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const auto at = [&](double by_rad) {
            std::vector<double> changed = joints_rad;
            changed[static_cast<std::size_t>(i)] += by_rad;
            return holding_nm(mass_matrix(robot.plant, changed), carrying);
        };
        slope.col(i) = (at(step_rad) - at(-step_rad)) / (2 * step_rad);
    }
    // What the joints have to move while the multirotor floats.
    const MatrixXd coupling = mass.bottomLeftCorner(count, 6);
    const MatrixXd floating = mass.bottomRightCorner(count, count) -
                              coupling * mass.topLeftCorner<6, 6>().ldlt().solve(MatrixXd(coupling.transpose()));
    // Restoring where positive.
    const Eigen::VectorXcd squares = MatrixXd(floating.ldlt().solve(slope)).eigenvalues();
    double asked_1_s2 = 0;
    for (const std::complex<double>& square : squares) {
        asked_1_s2 = std::max(asked_1_s2, (square.real() > 0 ? 0.5 : 1.0) * std::abs(square));
    }
    return asked_1_s2;
}

double greatest_joint_stiffness_asked_1_s2(const SpaceRobot& robot) {
    double most_1_s2 = 0;
    for_each_pose(robot, [&](const std::vector<double>& joints_rad) {
        most_1_s2 = std::max(most_1_s2, joint_stiffness_asked_1_s2(robot, joints_rad));
    });
    return most_1_s2;
}

SpaceInversion designed_inversion(const SpaceRobot& robot, SpaceBandwidths wanted) {
    // What acts late by T allows a critically damped loop 0.35 / T: 30 deg of phase and 6 dB of gain are left to it.
    constexpr double share_of_lag = 0.35, max_attitude_rad_s = 12;
    const double late_s = robot.controller.delay_s + 0.5 / robot.controller.rate_hz;
    if (!wanted.attitude_rad_s) {
        wanted.attitude_rad_s = std::min(share_of_lag / (robot.plant.time_constant_s + late_s), max_attitude_rad_s);
    }
    const double asked_1_s2 = wanted.joint_rad_s ? 0 : greatest_joint_stiffness_asked_1_s2(robot);
    const auto designed = [&](double observer_share, double stiffness_part) {
        SpaceBandwidths bandwidths = wanted;
        if (!wanted.joint_rad_s) {
            bandwidths.joint_rad_s =
                std::min(std::max(SpaceBandwidths::least_joint_rad_s,
                                  std::sqrt(stiffness_part * asked_1_s2 / stiffness_share(observer_share))),
                         share_of_lag / late_s);
        }
        if (!wanted.observer_gain_1_s) {
            bandwidths.observer_gain_1_s =
                std::max(SpaceBandwidths::least_observer_1_s, observer_share * *bandwidths.joint_rad_s);
        }
        return law_for(robot, bandwidths);
    };
    SpaceInversion best = designed(observer_shares[0], stiffness_parts[0]);
    if (wanted.joint_rad_s || wanted.observer_gain_1_s) {
        return best;
    }
    double best_part = 0;
    for (const double observer_share : observer_shares) {
        for (const double stiffness_part : stiffness_parts) {
            const SpaceInversion law = designed(observer_share, stiffness_part);
            const double part = part_of_margins(robot, law);
            if (part >= 1) {
                return law;
            }
            if (part > best_part) {
                best = law;
                best_part = part;
            }
        }
    }
    return best;
}

Px4Cascade designed_cascade(const SpaceRobot& robot, const SpaceBandwidths& wanted) {
    Px4Cascade law = cascade_gains_for(robot.plant.time_constant_s, wanted);
    const Eigen::LDLT<Matrix3d> inertia = matrix_of(robot.plant.multirotor.inertia_kg_m2).ldlt();
    for_each_pose(robot, [&](const std::vector<double>& joints_rad) {
        constexpr double reserve = 1.5;  // for what lifts unlike, and for gusts
        const MatrixXd mass = mass_matrix(robot.plant, joints_rad);
        const VectorXd weighs = reserve * standard_gravity_m_s2 * mass.col(2);
        const auto count = static_cast<Eigen::Index>(joints_rad.size());
        const VectorXd turns = inertia.solve(weighs.segment<3>(3));
        const VectorXd joints = mass.bottomRightCorner(count, count).ldlt().solve(weighs.tail(count));
        const auto raise = [](double& limit, double asked) {
            constexpr double highest_limit = 1e4;  // of the key
            limit = std::clamp(asked, limit, highest_limit);
        };
        raise(law.rate.integral_limit, turns.head<2>().cwiseAbs().maxCoeff());
        raise(law.joint.integral_limit, joints.cwiseAbs().maxCoeff());
    });
    return law;
}

}  // namespace downwash
