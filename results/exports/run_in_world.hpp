#pragma once

// Private: not installed. A run of either family as exports see it.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/controllers/axes.hpp"
#include "downwash/exports/way_in_world.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash {

/// A joint of the arm.
struct JointInWorld {
    std::string name;  ///< in messages
    Axis axis;         ///< its columns in trajectory.csv
};

/// The surfaces of a robot, for those who show it.
struct RobotSurfaces {
    struct Link {
        std::string name;
        Vector3 joint_m{};  ///< in the frame of what it is mounted on: the multirotor, or the link before
        Vector3 axis{};     ///< of its joint, of length 1, in the same frame
        TriangleMesh surface;
    };

    std::string name;
    std::vector<std::pair<std::string, TriangleMesh>> body;  ///< parts of the multirotor with what they are
    std::vector<Link> links;                                 ///< from the multirotor outward
};

/// A run in the world frame, with full attitude and any joints. It refers to the record that it is made of.
struct RunInWorld {
    const std::string& name;
    const std::string& solution_text;
    const NumberTable& flight;
    const std::vector<Obstacle>& obstacles;
    std::size_t rotors = 0;
    double rate_hz = 0;        ///< of the controller
    double max_speed_m_s = 0;  ///< of references
    bool turns = false;        ///< whether yaw is an axis of the plan
    bool has_touch = false;    ///< whether the flight has a touch, which follows the measured force
    std::vector<JointInWorld> joints = {};
    std::optional<WayInWorld> plan = {};

    SpacePose start = {};
    std::function<SpacePose(std::size_t row)> pose = {};          ///< in a row of the flight
    std::function<Vector3(std::size_t row)> end_effector_m = {};  ///< in a row of the flight
    std::function<RobotSurfaces()> robot = {};
};

/// @param run outlives what is returned
[[nodiscard]] RunInWorld in_world(const RunRecord& run);
[[nodiscard]] RunInWorld in_world(const SpaceRunRecord& run);

}  // namespace downwash
