#include "downwash/problems/cut_off_goals.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "downwash/scene/parted_plane.hpp"

namespace downwash {
namespace {

/// How far the nearest and the farthest point of a square are from a point [m].
struct Distances {
    double nearest_m, farthest_m;
};

Distances distances(const PlaneSquare& square, double x_m, double z_m) {
    const double dx = std::abs(square.x_m - x_m);
    const double dz = std::abs(square.z_m - z_m);
    const double half_m = square.half_m;
    return {std::hypot(std::max(0.0, dx - half_m), std::max(0.0, dz - half_m)), std::hypot(dx + half_m, dz + half_m)};
}

/// Where the centre of mass may be when a goal without alternatives is met. Nothing is asked of angles.
struct MayMeet {
    const PlaneSquare& square;
    const ArmParameters& arm;
    double tolerance_m;

    bool operator()(const ConfigurationGoal& goal) const {
        return distances(square, goal.x_m.value_or(square.x_m), goal.z_m.value_or(square.z_m)).nearest_m <= tolerance_m;
    }
    /// The joint is at a fixed distance from the centre of mass, and the end effector at another one from the joint.
    bool operator()(const EndEffectorGoal& goal) const {
        const double offset_m = std::hypot(arm.joint_x_m, arm.joint_z_m);
        const auto [nearest_m, farthest_m] = distances(square, goal.x_m, goal.z_m);
        return nearest_m <= arm.length_m + offset_m + tolerance_m &&
               farthest_m >= std::abs(arm.length_m - offset_m) - tolerance_m;
    }
    bool operator()(const ContactGoal& /*goal*/) const { return true; }
};

bool may_meet(const Goal& goal, const ArmParameters& arm, const PlaneSquare& square) {
    if (may_touch(goal)) {
        return true;
    }
    const auto all = alternatives(goal);
    return std::any_of(all.begin(), all.end(), [&](const Goal& each) {
        constexpr double rounding_m = 1e-6;
        const GoalTolerance tolerance = tolerance_of(each);
        const double widest_m = tolerance.is_disc ? tolerance.x_m : std::hypot(tolerance.x_m, tolerance.z_m);
        return std::visit(MayMeet{square, arm, widest_m + rounding_m}, each.kind);
    });
}

}  // namespace

std::vector<CutOffGoal> cut_off_goals(const Problem& problem, const Scene& scene) {
    const std::vector<Goal> goals = goals_of(problem);
    std::vector<MayBeIn> regions;
    regions.reserve(goals.size());
    for (const Goal& goal : goals) {
        regions.emplace_back([&](const PlaneSquare& square) { return may_meet(goal, problem.robot.arm, square); });
    }
    const Configuration& start = problem.start.at;
    std::vector<CutOffGoal> cut_off;
    for (const CutOffRegion& each : cut_off_regions(scene, problem.plane, problem.robot.shape(), problem.bounds,
                                                    start[plane::x], start[plane::z], regions)) {
        cut_off.push_back({each.region, each.obstacles});
    }
    return cut_off;
}

bool leave_no_plan(const std::vector<CutOffGoal>& cut_off, const Problem& problem) {
    if (problem.targets.empty()) {
        return !cut_off.empty();
    }
    const std::size_t targets = problem.targets.size();
    const auto is_target = [targets](const CutOffGoal& each) { return each.goal < targets; };
    const auto of_targets = static_cast<std::size_t>(std::count_if(cut_off.begin(), cut_off.end(), is_target));
    return of_targets == targets || of_targets < cut_off.size();
}

std::string quoted_labels(const std::vector<std::string>& labels) {
    std::string text;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        text += i == 0 ? "" : i + 1 == labels.size() ? " and " : ", ";
        text += "'" + labels[i] + "'";
    }
    return text;
}

}  // namespace downwash
