#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash {

/// Thrust of each rotor in a level hover in free air, by where the common centre of mass is: linear in its place.
struct DOWNWASH_EXPORT HoverThrusts {
    std::vector<double> middle_n;               ///< with the weight at the multirotor's centre of mass
    std::vector<double> forward_n_m, left_n_m;  ///< more for every metre that the weight is forward or left of it

    /// @param at_m from the multirotor's centre of mass
    [[nodiscard]] std::vector<double> at(const Vector3& at_m) const;
};

/// What pages and summaries show of a robot of a vertical plane or of space.
struct ShownRobot {
    /// That of a plane with its arm as a link about y, and rotors that do not say how they turn: spin 0.
    SpaceRobot robot;
    bool is_planar = false;
    double thrust_to_weight = 0, reach_m = 0;
    HoverThrusts hover;
    // Greatest share of its largest thrust that any rotor needs for a hover in any pose that was tried, and where.
    double hover_share = 0;
    std::size_t hover_rotor = 0;
    std::vector<double> hover_joints_rad;
    /// The pose that is shown: every joint at zero, or as near as its limits allow.
    std::vector<double> joints_rad;
};

/// @pre space_robot_errors(robot) is empty
[[nodiscard]] DOWNWASH_EXPORT ShownRobot shown_robot(const SpaceRobot& robot);
/// @pre robot_errors(robot) is empty
[[nodiscard]] DOWNWASH_EXPORT ShownRobot shown_robot(const Robot& robot);

/// Thrust of each rotor in a level hover in that pose, over its greatest.
[[nodiscard]] DOWNWASH_EXPORT std::vector<double> hover_shares(const ShownRobot& shown);

}  // namespace downwash
