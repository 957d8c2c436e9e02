#include "downwash/problems/space_goal_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "downwash/base/text.hpp"
#include "downwash/problems/cut_off_goals.hpp"
#include "downwash/problems/space_goal_parameters.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/scene/parted_space.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/shape_parameters.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/space_goal_reach.hpp"
#include "downwash/simulation/space_press.hpp"
#include "downwash/simulation/space_touch_place.hpp"

namespace downwash {
namespace {

/// A ball inside of a solid of the multirotor: where the robot gets, the ball does.
struct InnerBall {
    double radius_m = 0;
    Vector3 center_m = {};  ///< from the multirotor's centre of mass, in its frame
};

/// The greatest radius of a ball around the middle of a solid.
struct InnerRadius {
    double operator()(const Box& box) const { return 0.5 * *std::min_element(box.size_m.begin(), box.size_m.end()); }
    double operator()(const Sphere& sphere) const { return sphere.radius_m; }
    double operator()(const Cylinder& can) const { return std::min(can.radius_m, 0.5 * can.length_m); }
    double operator()(const Capsule& capsule) const { return capsule.radius_m; }
};

InnerBall inner_ball(const SpaceRobot& robot) {
    InnerBall largest;
    for (const SpaceBodyShape& body : robot.body) {
        const double radius_m = std::visit(InnerRadius{}, body.shape);
        if (radius_m > largest.radius_m) {
            const auto* capsule = std::get_if<Capsule>(&body.shape);
            largest = {radius_m, body.center_m + (capsule != nullptr ? capsule->from_m : Vector3{})};
        }
    }
    return largest;
}

/// What all goals of a problem are asked about.
class GoalCheck {
 public:
    explicit GoalCheck(const SpaceProblem& problem)
        : problem_(problem),
          scene_(std::make_shared<const Scene>(problem.obstacles)),
          checker_(scene_, shape_of(problem.robot), problem.planner.collision_checker),
          ball_(inner_ball(problem.robot)) {
        const SpaceMotion start = start_motion(problem.start);
        const SpacePose pose{start.position_m, start.attitude, start.joints_rad};
        start_m_ = center_at(pose);
        is_start_free_ = !checker_.is_nearer_than(pose, 0);
    }

    [[nodiscard]] std::optional<SpaceGoalObjection> objection(const SpaceGoal& goal) const {
        const double margin_m = problem_.planner.safety_margin_m;
        SpaceGoalReach reach = goal_reach(problem_.robot, problem_.bounds, scene_, checker_, margin_m, goal);
        if (!reach.objection) {
            reach.objection = too_strong(goal);
        }
        return reach.objection ? std::move(reach.objection) : cut_off(goal);
    }

 private:
    [[nodiscard]] Vector3 center_at(const SpacePose& pose) const {
        return pose.position_m + rotation_of(pose.attitude) * ball_.center_m;
    }

    /// That the robot cannot press so hard at any of some free configurations of a contact.
    [[nodiscard]] std::optional<SpaceGoalObjection> too_strong(const SpaceGoal& goal) const {
        const auto* contact = std::get_if<SpaceContactGoal>(&goal.kind);
        if (contact == nullptr) {
            return std::nullopt;
        }
        std::vector<Obstacle> named;
        std::ranges::copy_if(problem_.obstacles, std::back_inserter(named),
                             [&](const Obstacle& obstacle) { return obstacle.name == contact->obstacle; });
        const Scene alone(std::move(named));
        constexpr int tries = 20;
        const SpaceGoalSampler sampler(problem_.robot, problem_.bounds, scene_, checker_,
                                       problem_.planner.safety_margin_m, goal);
        Random random(3);
        std::string lack;
        int places = 0;
        for (int i = 0; i < tries; ++i) {
            const auto place = sampler.sample(random, 0).place;
            if (!place) {
                continue;
            }
            const SpacePose waiting = level_at(place->at);
            const FoundTouch found = find_touch(*contact, goal.hold_s, problem_.robot, waiting, alone);
            if (!found.touch) {
                continue;
            }
            lack = lacks_to_press(problem_.robot, waiting, *found.touch);
            if (lack.empty()) {
                return std::nullopt;
            }
            ++places;
        }
        return places == 0 ? std::nullopt
                           : std::optional(SpaceGoalObjection{
                                 "force_n", lack + ", at each of " + std::to_string(places) +
                                                " places that were tried; press less, or give the robot more"});
    }

    /// That no way leads from the start to any of some free configurations of a goal.
    [[nodiscard]] std::optional<SpaceGoalObjection> cut_off(const SpaceGoal& goal) const {
        if (ball_.radius_m == 0 || !is_start_free_) {
            return std::nullopt;
        }
        constexpr int places = 40;
        const SpaceGoalSampler sampler(problem_.robot, problem_.bounds, scene_, checker_,
                                       problem_.planner.safety_margin_m, goal);
        Random random(2);
        std::vector<Vector3> ends_m;
        for (int i = 0; i < places; ++i) {
            if (const auto place = sampler.sample(random, i % 2 == 0 ? 0 : usable_tolerance_share).place) {
                ends_m.push_back(center_at(level_at(place->at)));
            }
        }
        SpaceBounds bounds = problem_.bounds;
        const double beside_m = std::sqrt(dot(ball_.center_m, ball_.center_m));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bounds.low_m[axis] -= beside_m;
            bounds.high_m[axis] += beside_m;
        }
        const std::optional<BallWay> way = way_of_ball(scene_, bounds, ball_.radius_m, start_m_, ends_m);
        if (!way || !way->is_parted) {
            return std::nullopt;
        }
        std::vector<std::string> labels;
        for (const std::size_t obstacle : way->obstacles) {
            labels.push_back(label_of(problem_.obstacles, obstacle));
        }
        return SpaceGoalObjection{"", "is cut off from the start: not even a ball of " + to_text(ball_.radius_m, 3) +
                                          " m, as it fits into the multirotor, gets past " + quoted_labels(labels) +
                                          " within environment.bounds; open a way, widen the bounds or move the goal"};
    }

    const SpaceProblem& problem_;
    std::shared_ptr<const Scene> scene_;
    SpaceChecker checker_;
    InnerBall ball_;
    Vector3 start_m_{};
    bool is_start_free_ = false;
};

}  // namespace

std::vector<KeyError> space_goal_warnings(const SpaceProblem& problem) {
    struct Named {
        const SpaceGoal& goal;
        std::string key;
    };
    std::vector<Named> all;
    for_each_goal(problem, [&](const SpaceGoal& goal, const std::string& key) { all.push_back({goal, key}); });
    const GoalCheck check(problem);
    std::vector<KeyError> warnings;
    auto next = all.begin();
    for (const SpaceGoal& goal : goals_of(problem)) {
        const auto end = next + static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, goal.any_of.size()));
        std::vector<KeyError> of_goal;
        for (; next != end; ++next) {
            const std::optional<SpaceGoalObjection> objection = check.objection(next->goal);
            if (!objection) {
                of_goal.clear();
                next = end;
                break;
            }
            const std::string& key = objection->key;
            of_goal.push_back({key.empty() ? next->key : next->key + "." + key, objection->reason});
        }
        warnings.insert(warnings.end(), of_goal.begin(), of_goal.end());
    }
    return warnings;
}

}  // namespace downwash
