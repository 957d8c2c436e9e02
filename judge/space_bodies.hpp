#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "downwash/judge/space_vehicle.hpp"

// Rigid bodies in maximal coordinates: six speeds for each body, five constraints for each joint, three more that hold
// a planar vehicle in its plane. Private: not installed.

namespace downwash::judge {

/// The motion of one body, all in world axes.
struct BodyMotion {
    Eigen::Vector3d position_m;  ///< of its centre of mass
    Eigen::Quaterniond attitude;
    Eigen::Vector3d velocity_m_s, rate_rad_s;
};
using BodyMotions = std::vector<BodyMotion>;

/// The same motion as sensors tell it.
struct SpaceCoordinates {
    Eigen::Vector3d position_m;  ///< of the multirotor's centre of mass
    Eigen::Quaterniond attitude;
    Eigen::Vector3d velocity_m_s;
    Eigen::Vector3d body_rate_rad_s;  ///< body axes
    Eigen::VectorXd joints_rad, joint_rates_rad_s;
};

/// Where all bodies are and how they move. @param at its quaternion of any length but zero
[[nodiscard]] DOWNWASH_EXPORT BodyMotions bodies_at(const SpaceVehicle& vehicle, const SpaceCoordinates& at);
/// The coordinates of bodies. @param near_rad the joint angles, up to less than half a turn
[[nodiscard]] DOWNWASH_EXPORT SpaceCoordinates coordinates_of(const SpaceVehicle& vehicle, const BodyMotions& bodies,
                                                              const Eigen::VectorXd& near_rad);

/// A plane that the centre of mass of the multirotor does not leave, nor does its y axis turn away from the normal.
struct HeldPlane {
    Eigen::Vector3d point_m, normal;  ///< the normal of length 1
};

/// Force and torque on a body, world axes; the torque about its centre of mass.
struct BodyLoad {
    Eigen::Vector3d force_n = Eigen::Vector3d::Zero(), torque_nm = Eigen::Vector3d::Zero();

    /// Adds a force at a lever from the centre of mass.
    void push(const Eigen::Vector3d& lever_m, const Eigen::Vector3d& by_n) {
        force_n += by_n;
        torque_nm += lever_m.cross(by_n);
    }
};

/// Bodies and what holds them together.
class Linkage {
 public:
    /// @param vehicle outlives this   @param plane empty: the vehicle is free
    DOWNWASH_EXPORT explicit Linkage(const SpaceVehicle& vehicle, std::optional<HeldPlane> plane = {});

    /// Six accelerations of each body, the linear ones first, under loads besides weight:
    ///     ( M  J^T ) ( a )     ( loads, weight, -w x I w )
    ///     ( J   0  ) ( f )  =  ( -dJ/dt v               )
    /// solved for the constraint forces f first.
    [[nodiscard]] DOWNWASH_EXPORT Eigen::VectorXd accelerations(const BodyMotions& bodies,
                                                                const std::vector<BodyLoad>& loads) const;

    /// Moves bodies back to where the constraints hold, by as little as possible in the measure of the masses, and
    /// takes out of their speeds what breaks constraints.
    DOWNWASH_EXPORT void project(BodyMotions& bodies) const;

    /// The largest errors of the constraints [m or 1] and of their rates [m/s or rad/s].
    struct Errors {
        double place, speed;
    };
    [[nodiscard]] DOWNWASH_EXPORT Errors errors(const BodyMotions& bodies) const;

 private:
    struct Rows {
        Eigen::MatrixXd jacobian;
        Eigen::VectorXd error;  ///< of places
        Eigen::VectorXd drift;  ///< dJ/dt v
    };
    [[nodiscard]] Rows rows_at(const BodyMotions& bodies) const;
    /// M^-1 times columns of six numbers for each body.
    [[nodiscard]] Eigen::MatrixXd without_mass(const BodyMotions& bodies, const Eigen::MatrixXd& columns) const;

    const SpaceVehicle& vehicle_;
    std::optional<HeldPlane> plane_;
    std::vector<Eigen::Matrix3d> inverse_inertia_;
};

/// What bodies need to accelerate.
struct Needed {
    Eigen::Vector3d force_n;    ///< on all of them, weight carried, world axes
    Eigen::Vector3d torque_nm;  ///< the same about the multirotor's centre of mass, world axes
    Eigen::VectorXd joints_nm;
};

/// Inverse dynamics by Newton and Euler for each body, in world axes.
/// @param acceleration_m_s2,turn_rad_s2 of the multirotor, world axes   @param joints_rad_s2 of the joints
/// @param gravity_m_s2 0: without weight
[[nodiscard]] DOWNWASH_EXPORT Needed needed_for(const SpaceVehicle& vehicle, const BodyMotions& bodies,
                                                const Eigen::Vector3d& acceleration_m_s2,
                                                const Eigen::Vector3d& turn_rad_s2,
                                                const Eigen::VectorXd& joints_rad_s2, double gravity_m_s2);

/// A force on a point of a body.
struct BodyPush {
    std::size_t body;
    Eigen::Vector3d lever_m;  ///< from the centre of mass of the body, in its axes
    Eigen::Vector3d force_n;  ///< world axes
};

/// What a force does to all bodies, about the multirotor's centre of mass, and to the joints.
[[nodiscard]] DOWNWASH_EXPORT Needed push_on(const SpaceVehicle& vehicle, const BodyMotions& bodies,
                                             const BodyPush& push);

}  // namespace downwash::judge
