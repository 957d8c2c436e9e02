#include "downwash/judge/space_rotors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "downwash/base/infinity.hpp"

namespace downwash::judge {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Lift along b3 and torque per newton that acts. @param ratio K: the drag torque has none
Eigen::Vector4d column_of(const FlyingRotor& rotor, double ratio) {
    const Vector3d torque = rotor.hub_m.cross(rotor.axis) + rotor.reaction_m / ratio * rotor.axis;
    return {rotor.axis.z(), torque.x(), torque.y(), torque.z()};
}

Eigen::Matrix<double, 4, Eigen::Dynamic> columns_of(const SpaceVehicle& vehicle, const std::vector<double>& ratio) {
    Eigen::Matrix<double, 4, Eigen::Dynamic> columns(4, static_cast<Eigen::Index>(vehicle.rotors.size()));
    for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
        columns.col(static_cast<Eigen::Index>(i)) = column_of(vehicle.rotors[i], ratio[i]);
    }
    return columns;
}

/// The largest share in [0, 1] that is allowed, if all lesser ones are; 0 if none is.
template <class Allowed>
double largest_share(const Allowed& is_allowed) {
    if (is_allowed(1.0)) {
        return 1;
    }
    double low = 0;
    double high = 1;
    while (0.5 * (low + high) > low && 0.5 * (low + high) < high) {
        const double middle = 0.5 * (low + high);
        (is_allowed(middle) ? low : high) = middle;
    }
    return low;
}

}  // namespace

RotorShares::RotorShares(const SpaceVehicle& nominal, double tick_s, double rotor_lead)
    : nominal_(nominal), tick_s_(tick_s), rotor_lead_(rotor_lead) {
    const std::vector<double> ones(nominal.rotors.size(), 1);
    share_ = columns_of(nominal, ones).completeOrthogonalDecomposition().pseudoInverse();
    Vector3d force = Vector3d::Zero();
    for (std::size_t i = 0; i < nominal.rotors.size(); ++i) {
        force += share_(static_cast<Eigen::Index>(i), 0) * nominal.rotors[i].axis;
    }
    lift_axis_ = force.normalized();
    for (const FlyingRotor& rotor : nominal.rotors) {
        min_lift_n_ += rotor.min_thrust_n * rotor.axis.dot(lift_axis_);
        max_lift_n_ += rotor.max_thrust_n * rotor.axis.dot(lift_axis_);
    }
}

std::vector<double> RotorShares::thrusts_of(double lift_n) const {
    const VectorXd thrusts = share_.col(0) * lift_n;
    return {thrusts.data(), thrusts.data() + thrusts.size()};
}

ExpectedRotors RotorShares::command(const LiftAndTorque& demand, const std::vector<double>& ratio,
                                    const std::vector<double>& now_n) const {
    const auto rotors = static_cast<Eigen::Index>(nominal_.rotors.size());
    const Eigen::Vector4d asked(demand.lift_n, demand.torque_nm.x(), demand.torque_nm.y(), demand.torque_nm.z());
    const Eigen::Vector4d mended = Eigen::Matrix4d(columns_of(nominal_, ratio) * share_).fullPivLu().solve(asked);
    const VectorXd torque_n = share_.middleCols<2>(1) * mended.segment<2>(1);
    const VectorXd yaw_n = share_.col(3) * mended[3];
    const VectorXd acting = share_.col(0) * demand.lift_n + torque_n + yaw_n;
    VectorXd wanted(rotors), low(rotors), high(rotors);
    ExpectedRotors out{{}, Vector3d::Zero(), Vector3d::Zero(), -infinity};
    for (Eigen::Index i = 0; i < rotors; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const FlyingRotor& rotor = nominal_.rotors[k];
        wanted[i] = acting[i] / ratio[k];
        low[i] = ratio[k] * rotor.min_thrust_n;
        high[i] = ratio[k] * rotor.max_thrust_n;
        out.saturation = std::max(out.saturation, wanted[i] / rotor.max_thrust_n);
        if (wanted[i] < rotor.min_thrust_n) {
            out.saturation = std::max(out.saturation,
                                      1 + (rotor.min_thrust_n - wanted[i]) / (rotor.max_thrust_n - rotor.min_thrust_n));
        }
    }
    if (out.saturation > 1) {
        wanted = clipped(torque_n, yaw_n, demand.lift_n, low, high);
        for (Eigen::Index i = 0; i < rotors; ++i) {
            wanted[i] /= ratio[static_cast<std::size_t>(i)];
        }
    }
    const double lag_s = nominal_.rotor_time_constant_s;
    for (Eigen::Index i = 0; i < rotors; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const FlyingRotor& rotor = nominal_.rotors[k];
        const double led = lag_s > 0 ? wanted[i] + rotor_lead_ * (wanted[i] - now_n[k]) : wanted[i];
        const double command = std::clamp(led, rotor.min_thrust_n, rotor.max_thrust_n);
        out.command_n.push_back(command);
        const double expected =
            lag_s > 0 ? now_n[k] + (command - now_n[k]) * 0.5 * tick_s_ / (0.5 * tick_s_ + lag_s) : command;
        const Vector3d push = ratio[k] * expected * rotor.axis;
        out.force_n += push;
        out.torque_nm += rotor.hub_m.cross(push) + rotor.reaction_m * expected * rotor.axis;
    }
    return out;
}

VectorXd RotorShares::clipped(const VectorXd& torque_n, const VectorXd& yaw_n, double lift_n, const VectorXd& low_n,
                              const VectorXd& high_n) const {
    const VectorXd lift_share = share_.col(0);
    struct Range {
        double low_n, high_n;
    };
    // The lifts that keep all rotors with a part in the lift within limits.
    const auto lifts = [&](double share) {
        Range range{-infinity, infinity};
        for (Eigen::Index i = 0; i < lift_share.size(); ++i) {
            if (lift_share[i] > 1e-3 * lift_share.maxCoeff()) {
                range.low_n = std::max(range.low_n, (low_n[i] - share * torque_n[i]) / lift_share[i]);
                range.high_n = std::min(range.high_n, (high_n[i] - share * torque_n[i]) / lift_share[i]);
            }
        }
        return range;
    };
    const double share = largest_share([&](double s) { return lifts(s).low_n <= lifts(s).high_n; });
    const Range range = lifts(share);
    const double lift = std::max(range.low_n, std::min(lift_n, range.high_n));
    const VectorXd level = (lift_share * lift + share * torque_n).cwiseMax(low_n).cwiseMin(high_n);
    const double yaw_share = largest_share([&](double s) {
        return ((level + s * yaw_n - low_n).array() >= 0).all() && ((high_n - level - s * yaw_n).array() >= 0).all();
    });
    return (level + yaw_share * yaw_n).cwiseMax(low_n).cwiseMin(high_n);
}

}  // namespace downwash::judge
