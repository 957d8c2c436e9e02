#include "downwash/simulation/space_goal_rule.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/space_configuration.hpp"
#include "downwash/simulation/space_touch_place.hpp"

namespace downwash {
namespace {

std::span<const SpaceGoal> alternatives(const SpaceGoal& goal) {
    return goal.any_of.empty() ? std::span<const SpaceGoal>(&goal, 1) : std::span<const SpaceGoal>(goal.any_of);
}

SpacePose pose_of(const SpaceMotion& motion) {
    return {motion.position_m, motion.attitude, motion.joints_rad};
}

/// Whether the reference of a plan stays at a knot from the one before on.
bool is_hover(const SpaceKnot& from, const SpaceKnot& to) {
    return from.point == to.point && is_at_rest(to.point);
}

}  // namespace

struct SpaceGoalRule::Impl {
    SpaceRobot robot;
    std::shared_ptr<const Scene> scene;
    std::vector<SpaceGoal> goals;
    bool in_any_order;
    /// Of each goal and each of its alternatives: the obstacles that a contact names, alone; nullptr for other kinds.
    std::vector<std::vector<std::shared_ptr<const Scene>>> touched;

    /// What a reference point has to do with a goal: the alternative whose tolerances it uses least.
    struct Fit {
        SpaceGoalError error;
        double hold_s = 0;
        FoundTouch found;
    };
    /// @param i number of an alternative of the goal; 0 of one without
    [[nodiscard]] Fit fit(std::size_t number, std::size_t i, const SpacePose& pose) const {
        const SpaceGoal& goal = alternatives(goals[number])[i];
        Fit one{goal_error(goal, robot, pose, *scene), goal.hold_s, {}};
        if (const auto* contact = std::get_if<SpaceContactGoal>(&goal.kind)) {
            one.found = find_touch(*contact, goal.hold_s, robot, pose, *touched[number][i]);
            one.hold_s = touch_hover_s;
            if (one.found.touch) {
                one.error = goal_error(*one.found.touch, robot, pose);
            } else {
                one.error.distance_m = one.found.away_m;
            }
        }
        return one;
    }
    [[nodiscard]] Fit fit(std::size_t number, const SpaceConfiguration& at) const {
        const SpacePose pose = level_at(at);
        Fit best = fit(number, 0, pose);
        for (std::size_t i = 1; i < touched[number].size(); ++i) {
            Fit one = fit(number, i, pose);
            const bool is_as_good = !is_less(best.error, one.error);
            if (is_less(one.error, best.error) || (is_as_good && one.error.distance_m < best.error.distance_m)) {
                best = std::move(one);
            }
        }
        return best;
    }
};

SpaceGoalRule::SpaceGoalRule(const SpaceRobot& robot, std::shared_ptr<const Scene> scene, std::vector<SpaceGoal> goals,
                             bool in_any_order) {
    assert(scene != nullptr && !goals.empty());
    auto impl = std::make_unique<Impl>(Impl{robot, std::move(scene), std::move(goals), in_any_order, {}});
    for (const SpaceGoal& goal : impl->goals) {
        std::vector<std::shared_ptr<const Scene>>& touched = impl->touched.emplace_back();
        for (const SpaceGoal& each : alternatives(goal)) {
            std::shared_ptr<const Scene>& obstacles = touched.emplace_back();
            if (const auto* contact = std::get_if<SpaceContactGoal>(&each.kind)) {
                std::vector<Obstacle> named;
                for (const Obstacle& one : impl->scene->obstacles()) {
                    if (one.name == contact->obstacle) {
                        named.push_back(one);
                    }
                }
                obstacles = std::make_shared<const Scene>(std::move(named));
            }
        }
    }
    impl_ = std::move(impl);
}

SpaceGoalRule::~SpaceGoalRule() = default;

const std::vector<SpaceGoal>& SpaceGoalRule::goals() const noexcept {
    return impl_->goals;
}

std::vector<SpaceGoalHover> SpaceGoalRule::hovers(const SpacePlan& plan) const {
    const Impl& own = *impl_;
    const auto ticks = [&](double hold_s) {
        return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(hold_s / plan.tick_s - 1e-9)));
    };
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < own.goals.size(); ++i) {
        left.push_back(i);
    }
    std::vector<SpaceGoalHover> hovers;
    for (std::size_t i = 1; i < plan.reference.size() && left.size() > 1; ++i) {
        const SpaceKnot& from = plan.reference[i - 1];
        const SpaceKnot& to = plan.reference[i];
        if (!is_hover(from, to)) {
            continue;
        }
        for (std::size_t k = 0; k < (own.in_any_order ? left.size() : 1); ++k) {
            Impl::Fit fit = own.fit(left[k], configuration_of(to.point));
            if (is_met(fit.error) && to.tick - from.tick >= ticks(fit.hold_s)) {
                hovers.push_back({left[k], to.tick, std::move(fit.found.touch), std::move(fit.found.reason)});
                left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
                break;
            }
        }
    }
    const SpaceKnot& last = plan.reference.back();
    std::optional<Impl::Fit> best;
    std::size_t goal = 0;
    for (std::size_t k = 0; k < (own.in_any_order ? left.size() : 1); ++k) {
        Impl::Fit fit = own.fit(left[k], configuration_of(last.point));
        if (!best || is_less(fit.error, best->error)) {
            best = std::move(fit);
            goal = left[k];
        }
    }
    hovers.push_back(
        {goal, last.tick + ticks(best->hold_s), std::move(best->found.touch), std::move(best->found.reason)});
    return hovers;
}

SpaceGoalHover SpaceGoalRule::hover_at(std::size_t goal, const SpacePoint& point) const {
    if (std::ranges::none_of(impl_->touched[goal], [](const auto& named) { return named != nullptr; })) {
        return {goal, 0, {}, {}};
    }
    Impl::Fit fit = impl_->fit(goal, configuration_of(point));
    return {goal, 0, std::move(fit.found.touch), std::move(fit.found.reason)};
}

std::vector<SpaceGoalError> SpaceGoalRule::errors_at(std::size_t goal, const SpaceConfiguration& at) const {
    const SpacePose pose = level_at(at);
    std::vector<SpaceGoalError> errors;
    for (std::size_t i = 0; i < impl_->touched[goal].size(); ++i) {
        errors.push_back(impl_->fit(goal, i, pose).error);
    }
    return errors;
}

SpaceGoalError SpaceGoalRule::error_at(std::size_t goal, const SpaceConfiguration& at) const {
    return impl_->fit(goal, at).error;
}

SpaceGoalError SpaceGoalRule::error(const SpaceGoalHover& hover, const SpaceMotion& motion,
                                    const SpaceWorld& world) const {
    const Impl& own = *impl_;
    const SpacePose pose = pose_of(motion);
    if (hover.touch) {
        return goal_error(*hover.touch, own.robot, pose);
    }
    std::optional<SpaceGoalError> least;
    for (const SpaceGoal& each : alternatives(own.goals[hover.goal])) {
        const SpaceGoalError one = goal_error(each, own.robot, pose, *own.scene, world);
        if (!least || is_less(one, *least)) {
            least = one;
        }
    }
    return *least;
}

bool meets_goal(const SpaceGoalError& error, const SpaceMotion& motion) noexcept {
    return is_met(error) && lane::sqrt(dot(motion.velocity_m_s, motion.velocity_m_s)) < goal_max_speed_m_s;
}

}  // namespace downwash
