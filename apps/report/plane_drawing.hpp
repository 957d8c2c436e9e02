#pragma once

// Private: not installed. What pictures of runs and of problems draw alike.

#include <string>
#include <vector>

#include "downwash/problems/problem.hpp"
#include "downwash/report/field.hpp"

namespace downwash {

/// The lines of vehicle and arm at a place.
class RobotDrawing {
 public:
    /// @param robot must outlive this
    explicit RobotDrawing(const Robot& robot) : robot_(robot), bodies_(body_outlines(robot.body)) {}

    /// The width between the outer edges of the outermost rotors.
    [[nodiscard]] double width_m() const;

    void add_to(std::vector<Ring>& lines, double x_m, double z_m, double pitch_rad, double arm_rad) const;

 private:
    const Robot& robot_;
    std::vector<Ring> bodies_;
};

/// The name of a goal as it stands beside its point: the number alone, which needs little room.
[[nodiscard]] std::string short_name(const std::string& name);

/// The goals that are a point of the plane; several in turn with their numbers.
/// @param names of goals_of(problem)
[[nodiscard]] std::vector<FigurePoints> goal_points(const Problem& problem, const std::vector<std::string>& names);

/// Where the end effector may be at such goals.
[[nodiscard]] std::vector<Ring> goal_regions(const Problem& problem);

/// Widens the shorter side of an extent until it can be drawn to scale.
void widen_to_scale(Bounds& extent);

}  // namespace downwash
