#include "downwash/problems/buried_goals.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <variant>

#include "downwash/base/direction.hpp"
#include "downwash/problems/number_text.hpp"
#include "downwash/problems/space_goal_parameters.hpp"
#include "downwash/scene/obstacle_placement.hpp"
#include "downwash/simulation/space_goal_error.hpp"

namespace downwash {
namespace {

using problems::rounded;

/// How deep a point in the frame of a shape is below its surface [m]; below 0 outside. Surfaces of files count as
/// hollow.
struct Depth {
    Vector3 at_m;

    double operator()(const Box& box) const {
        double depth_m = std::numeric_limits<double>::infinity();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            depth_m = std::min(depth_m, 0.5 * box.size_m[axis] - std::abs(at_m[axis]));
        }
        return depth_m;
    }
    double operator()(const Cylinder& can) const {
        const double along_m = dot(at_m, can.axis) / length_of(can.axis);
        const double beside_m = std::sqrt(std::max(0.0, dot(at_m, at_m) - along_m * along_m));
        return std::min(can.radius_m - beside_m, 0.5 * can.length_m - std::abs(along_m));
    }
    double operator()(const Sphere& sphere) const { return sphere.radius_m - length_of(at_m); }
    template <class FromFile>
    double operator()(const FromFile& /*surface*/) const {
        return -1;
    }
};

/// A point of a body near another, both in the body's frame; of cylinders one of the axis.
struct PointNear {
    Vector3 at_m;

    Vector3 operator()(const Box& box) const {
        Vector3 inside_m{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            inside_m[axis] = std::clamp(at_m[axis], -0.5 * box.size_m[axis], 0.5 * box.size_m[axis]);
        }
        return inside_m;
    }
    Vector3 operator()(const Cylinder& can) const {
        const Vector3 end_m = (0.5 * can.length_m / length_of(can.axis)) * can.axis;
        return on_segment(-1 * end_m, end_m);
    }
    Vector3 operator()(const Sphere& /*sphere*/) const { return {}; }
    Vector3 operator()(const Capsule& capsule) const { return on_segment(capsule.from_m, capsule.to_m); }

 private:
    [[nodiscard]] Vector3 on_segment(const Vector3& from_m, const Vector3& to_m) const {
        const Vector3 way_m = to_m - from_m;
        const double square = dot(way_m, way_m);
        const double share = square > 0 ? std::clamp(dot(at_m - from_m, way_m) / square, 0.0, 1.0) : 0.0;
        return from_m + share * way_m;
    }
};

/// How far at most a point of a body is from the nearest point of its solids; infinite if it has none.
double gap_m(const std::vector<SpaceBodyShape>& body, const Vector3& at_m) {
    double least_m = std::numeric_limits<double>::infinity();
    for (const SpaceBodyShape& solid : body) {
        const Vector3 local_m = at_m - solid.center_m;
        least_m = std::min(least_m, length_of(std::visit(PointNear{local_m}, solid.shape) - local_m));
    }
    return least_m;
}

struct Burial {
    std::string obstacle;
    double depth_m = 0;
};

/// Where a point is deepest inside an obstacle.
Burial burial(const SpaceProblem& p, const Vector3& at_m) {
    Burial deepest;
    for (std::size_t i = 0; i < p.obstacles.size(); ++i) {
        const Obstacle& obstacle = p.obstacles[i];
        const Matrix3 turn = rotation_of(obstacle.rpy_rad);
        const Vector3 from_center_m = at_m - obstacle.center_world_m;
        Vector3 local_m{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            local_m[axis] = dot({turn[0][axis], turn[1][axis], turn[2][axis]}, from_center_m);
        }
        const double depth_m = std::visit(Depth{local_m}, obstacle.shape);
        if (depth_m > deepest.depth_m) {
            deepest = {label_of(p.obstacles, i), depth_m};
        }
    }
    return deepest;
}

/// @param within_m of the goal's point where some point of the robot is in any case
std::vector<KeyError> buried(const SpaceProblem& p, const Vector3& at_m, double within_m, const std::string& key,
                             const std::string& consequence) {
    const Burial where = burial(p, at_m);
    if (where.depth_m <= within_m) {
        return {};
    }
    return {{key, "is " + rounded(where.depth_m) + " m inside the obstacle '" + where.obstacle + "': " + consequence +
                      "; move the goal out of the obstacle"}};
}

struct BuriedGoal {
    const SpaceProblem& p;
    const std::string& key;

    std::vector<KeyError> operator()(const SpaceEndEffectorGoal& goal) const {
        return buried_end(goal.position_m, goal.tolerance_m);
    }
    std::vector<KeyError> operator()(const SpacePoseGoal& goal) const {
        return buried_end(goal.position_m, goal.tolerance_m);
    }
    std::vector<KeyError> operator()(const SpaceCameraGoal& goal) const {
        if (!goal.sees || goal.nearest_m <= sight_end_m) {
            return {};
        }
        return buried(p, goal.target_m, sight_end_m + sight_radius_m, key + ".target_m", "no camera sees it there");
    }
    std::vector<KeyError> operator()(const SpaceConfigurationGoal& goal) const {
        if (!goal.x_m || !goal.y_m || !goal.z_m) {
            return {};
        }
        return buried(p, {*goal.x_m, *goal.y_m, *goal.z_m}, goal.tolerance_m + gap_m(p.robot.body, {}), key,
                      "within tolerance_m of it the vehicle touches the obstacle");
    }
    std::vector<KeyError> operator()(const SpaceContactGoal& /*goal*/) const { return {}; }

 private:
    [[nodiscard]] std::vector<KeyError> buried_end(const Vector3& at_m, double tolerance_m) const {
        const std::vector<SpaceBodyShape>& body = p.robot.links.empty() ? p.robot.body : p.robot.links.back().body;
        return buried(p, at_m, tolerance_m + gap_m(body, p.robot.plant.end_effector_m), key + ".position_m",
                      "within tolerance_m of it the end effector touches the obstacle");
    }
};

}  // namespace

std::vector<KeyError> buried_goals(const SpaceProblem& problem) {
    std::vector<std::vector<KeyError>> found;  // of all goals, alternatives one by one
    for_each_goal(problem, [&](const SpaceGoal& goal, const std::string& key) {
        found.push_back(std::visit(BuriedGoal{problem, key}, goal.kind));
    });
    std::vector<KeyError> errors;
    auto next = found.begin();
    for (const SpaceGoal& goal : goals_of(problem)) {
        const auto end = next + static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, goal.any_of.size()));
        const bool can_be_met = std::any_of(next, end, [](const auto& of_one) { return of_one.empty(); });
        for (; next != end; ++next) {
            if (!can_be_met) {
                errors.insert(errors.end(), next->begin(), next->end());
            }
        }
    }
    return errors;
}

}  // namespace downwash
