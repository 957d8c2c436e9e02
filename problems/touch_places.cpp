#include "downwash/problems/touch_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <variant>

#include "downwash/base/text.hpp"
#include "downwash/problems/problem_check.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/simulation/pose.hpp"

namespace downwash {
namespace {

/// Between places that are tried [m].
constexpr double spacing_m = 0.25;
/// Among more than these, those that are spread evenly remain.
constexpr std::size_t max_places = 16;
/// Two rays to a flat surface may differ so much [m].
constexpr double flatness_m = 1e-3;

constexpr double nothing_m = std::numeric_limits<double>::infinity();

/// A way to a surface: along x or z.
struct Approach {
    PlaneVector direction;  ///< unit vector
    double arm_rad;         ///< with which the arm of the level vehicle points there
};
constexpr double quarter = std::numbers::pi / 2;
constexpr Approach upward{{0, 1}, -quarter};
constexpr Approach ways[] = {upward, {{1, 0}, 0}, {{-1, 0}, std::numbers::pi}, {{0, -1}, quarter}};

/// Why a place is none, from the first test to the last.
enum class Flaw { unseen, uneven, outside, blocked, unflyable };

/// Finds the places of one goal.
class TouchSearch {
 public:
    TouchSearch(const ProblemCheck& check, const Goal& goal)
        : problem_(check.problem()),
          contact_(std::get<ContactGoal>(goal.kind)),
          hold_s_(goal.hold_s),
          check_(check),
          target_(obstacle()) {
        if (contact_.part == TouchingPart::frame) {
            frame_points_m_ = frame_points(problem_.robot);
        }
    }

    TouchPlaces places() {
        if (contact_.part == TouchingPart::frame && frame_points_m_.empty()) {
            found_.reason =
                "needs a box, a sphere or an upright cylinder as the highest of robot.multirotor.body to touch with";
            return found_;
        }
        if (contact_.part == TouchingPart::frame) {
            search(upward);
        } else {
            for (const Approach& way : ways) {
                search(way);
            }
        }
        thin_out();
        return found_;
    }

 private:
    Scene obstacle() const {
        std::vector<Obstacle> only;
        for (const Obstacle& one : problem_.obstacles) {
            if (one.name == contact_.obstacle) {
                only.push_back(one);
            }
        }
        return Scene(std::move(only));
    }

    /// The ends of what is highest on the robot's body, front and back; none where that is round and lies.
    static std::vector<PlaneVector> frame_points(const Robot& robot) {
        struct Top {
            double height_m, back_m, front_m;
            bool is_sure;
        };
        const auto top_of = [](const BodyShape& body) -> Top {
            const Vector3& c = body.center_body_m;
            if (const Box* box = std::get_if<Box>(&body.shape)) {
                return {c[2] + box->size_m[2] / 2, c[0] - box->size_m[0] / 2, c[0] + box->size_m[0] / 2, true};
            }
            if (const Sphere* ball = std::get_if<Sphere>(&body.shape)) {
                return {c[2] + ball->radius_m, c[0], c[0], true};
            }
            const Cylinder& can = std::get<Cylinder>(body.shape);
            if (can.axis[0] == 0 && can.axis[1] == 0) {
                return {c[2] + can.length_m / 2, c[0] - can.radius_m, c[0] + can.radius_m, true};
            }
            return {c[2] + std::hypot(can.radius_m, can.length_m / 2), c[0], c[0], false};
        };
        Top top{-nothing_m, 0, 0, false};
        for (const BodyShape& body : robot.body) {
            const Top one = top_of(body);
            if (one.height_m > top.height_m) {
                top = one;
            } else if (one.height_m == top.height_m) {
                top = {top.height_m, std::min(top.back_m, one.back_m), std::max(top.front_m, one.front_m),
                       top.is_sure && one.is_sure};
            }
        }
        if (!top.is_sure) {
            return {};
        }
        if (top.back_m == top.front_m) {
            return {{top.back_m, top.height_m}};
        }
        return {{top.back_m, top.height_m}, {top.front_m, top.height_m}};
    }

    /// How far the obstacle is along a way from a point of the plane [m]: sphere tracing.
    double distance_along(const Approach& way, PlaneVector from) const {
        constexpr double dot_m = 1e-7;
        const double longest_m = problem_.bounds.x_high_m - problem_.bounds.x_low_m + problem_.bounds.z_high_m -
                                 problem_.bounds.z_low_m + 10;
        double gone_m = 0;
        for (int step = 0; step < 200 && gone_m < longest_m; ++step) {
            const PlaneVector at{from.x + gone_m * way.direction.x, from.z + gone_m * way.direction.z};
            const double free_m = disc_clearance_m(target_, problem_.plane.to_world(at.x, 0, at.z), dot_m);
            if (free_m < 1e-6) {
                return gone_m;
            }
            gone_m += free_m;
        }
        return nothing_m;
    }

    void search(const Approach& way) {
        const Bounds& bounds = problem_.bounds;
        const bool is_vertical = way.direction.x == 0;
        const std::optional<double>& wanted = is_vertical ? contact_.x_m : contact_.z_m;
        const double low_m = is_vertical ? bounds.x_low_m : bounds.z_low_m;
        const double high_m = is_vertical ? bounds.x_high_m : bounds.z_high_m;
        if ((is_vertical ? contact_.z_m : contact_.x_m) && !wanted) {
            return;  // the place is given across this way
        }
        if (wanted) {
            try_place(way, *wanted);
            return;
        }
        constexpr double most = 400;
        const double step_m = std::max(spacing_m, (high_m - low_m) / most);
        for (double k = std::ceil(low_m / step_m); k * step_m <= high_m; ++k) {
            try_place(way, k * step_m);
        }
    }

    /// @param across_m coordinate across the way
    void try_place(const Approach& way, double across_m) {
        const Bounds& bounds = problem_.bounds;
        const bool is_vertical = way.direction.x == 0;
        const double sign = is_vertical ? way.direction.z : way.direction.x;
        const auto begin = [&](double aside_m) {
            return is_vertical ? PlaneVector{across_m + aside_m, sign > 0 ? bounds.z_low_m : bounds.z_high_m}
                               : PlaneVector{sign > 0 ? bounds.x_low_m : bounds.x_high_m, across_m + aside_m};
        };
        const double along_m = distance_along(way, begin(0));
        if (along_m == nothing_m) {
            return;
        }
        double left_m = -contact_.tolerance_m;
        double right_m = contact_.tolerance_m;
        for (const PlaneVector& point : frame_points_m_) {
            left_m = std::min(left_m, point.x - contact_.tolerance_m);
            right_m = std::max(right_m, point.x + contact_.tolerance_m);
        }
        for (const double aside_m : {left_m, 0.5 * left_m, 0.5 * right_m, right_m}) {
            if (!(std::abs(distance_along(way, begin(aside_m)) - along_m) <= flatness_m)) {
                note(Flaw::uneven);
                return;
            }
        }
        const PlaneVector origin = begin(0);
        Goal goal;
        goal.touch.emplace();
        Touch& touch = *goal.touch;
        const double to_touch_m = along_m - (frame_points_m_.empty() ? problem_.robot.arm.radius_m : 0);
        touch.surface_m = {origin.x + to_touch_m * way.direction.x, origin.z + to_touch_m * way.direction.z};
        touch.normal = {-way.direction.x, -way.direction.z};
        touch.frame_points_m = frame_points_m_;
        touch.force_n = contact_.force_n;
        touch.force_tolerance_n = contact_.tolerance_n();
        touch.standoff_m = contact_.standoff_m;
        touch.speed_m_s = contact_.speed_m_s;
        touch.hold_s = hold_s_;
        goal.hold_s = touch_hover_s;
        const PlaneVector waiting{touch.surface_m.x + contact_.standoff_m * touch.normal.x,
                                  touch.surface_m.z + contact_.standoff_m * touch.normal.z};
        if (frame_points_m_.empty()) {
            auto& tip = goal.kind.emplace<EndEffectorGoal>();
            tip.x_m = waiting.x;
            tip.z_m = waiting.z;
            tip.tolerance_m = contact_.tolerance_m;
            tip.direction_rad = way.arm_rad;
        } else {
            auto& vehicle = goal.kind.emplace<ConfigurationGoal>();
            vehicle.x_m = waiting.x;
            vehicle.z_m = waiting.z - frame_points_m_.front().z;
            vehicle.tolerance_m = contact_.tolerance_m;
        }
        if (is_usable(goal, way)) {
            found_.places.push_back(std::move(goal));
        }
    }

    /// Whether the level vehicle can wait and touch there.
    bool is_usable(const Goal& goal, const Approach& way) {
        const PlantModel plant = make_plant_model(problem_.robot.multirotor, problem_.robot.arm, problem_.robot.rotors);
        Configuration waiting = problem_.start.at;
        if (part_of(goal) == GoalPart::end_effector) {
            waiting[plane::arm] = way.arm_rad;
        }
        waiting = placed_at(goal, plant, waiting, 0, 0);
        constexpr double air_m = 5e-4;
        const double ahead_m = contact_.standoff_m - air_m;
        PlanarPose touching = level_at(waiting);
        touching.x_m += ahead_m * way.direction.x;
        touching.z_m += ahead_m * way.direction.z;
        const Bounds& b = problem_.bounds;
        if (waiting[plane::x] < b.x_low_m || waiting[plane::x] > b.x_high_m || waiting[plane::z] < b.z_low_m ||
            waiting[plane::z] > b.z_high_m) {
            return note(Flaw::outside);
        }
        const auto& collisions = check_.collisions();
        if (collisions.is_nearer_than(level_at(waiting), problem_.planner.safety_margin_m) ||
            collisions.is_nearer_than(touching, 0)) {
            return note(Flaw::blocked);
        }
        const RotorParameters& rotors = problem_.robot.rotors;
        const double distance_m = problem_.aero.min_distance_radii * rotors.radius_m;
        for (const Vector3& hub : rotors.positions_m) {
            const Vector3 at = problem_.plane.to_world(touching.x_m + hub[0], hub[1], touching.z_m + hub[2]);
            if (problem_.aero.enabled && !disc_is_clear(*check_.scene(), at, rotors.radius_m, distance_m)) {
                nearest_radii_ =
                    std::max(nearest_radii_, disc_clearance_m(*check_.scene(), at, rotors.radius_m) / rotors.radius_m);
                return note(Flaw::unflyable);
            }
        }
        return true;
    }

    /// Keeps the flaw that comes last in the order of the tests, which is that of the best place. @return false
    bool note(Flaw flaw) {
        flaw_ = std::max(flaw_, flaw);
        return false;
    }

    [[nodiscard]] std::string reason() const {
        std::string where = "has no place to touch: ";
        switch (flaw_) {
            case Flaw::unseen:
                return where + "no way along x or z leads to the obstacle within the bounds" +
                       (contact_.x_m || contact_.z_m ? ", where x_m or z_m says" : "");
            case Flaw::uneven:
                return where + "its surface is not flat across the way for the width of what touches and tolerance_m";
            case Flaw::outside:
                return where + "the robot would wait outside the bounds";
            case Flaw::blocked:
                return where +
                       "the robot that waits there, standoff_m away, is nearer to an obstacle than "
                       "planner.safety_margin_m, or would touch with something else";
            case Flaw::unflyable:
                return where + "its rotors would come within " + to_text(nearest_radii_, 3) +
                       " radii of an obstacle: expected at least aero.min_distance_radii, " +
                       to_text(problem_.aero.min_distance_radii);
        }
        return where;
    }

    void thin_out() {
        std::vector<Goal>& places = found_.places;
        if (places.size() > max_places) {
            std::vector<Goal> kept;
            for (std::size_t i = 0; i < max_places; ++i) {
                kept.push_back(places[i * (places.size() - 1) / (max_places - 1)]);
            }
            places = std::move(kept);
        }
        if (places.empty()) {
            found_.reason = reason();
        }
    }

    const Problem& problem_;
    const ContactGoal& contact_;
    double hold_s_;
    const ProblemCheck& check_;
    Scene target_;
    std::vector<PlaneVector> frame_points_m_;
    TouchPlaces found_;
    double nearest_radii_ = 0;
    Flaw flaw_ = Flaw::unseen;
};

void find_places(const ProblemCheck& check, Goal& goal) {
    goal.places.clear();
    if (asks_for_contact(goal)) {
        goal.places = find_touches(check, goal).places;
        return;
    }
    for (Goal& each : goal.any_of) {
        find_places(check, each);
    }
    if (may_touch(goal)) {
        for (const Goal& each : goal.any_of) {
            const std::span<const Goal> places = alternatives(each);
            goal.places.insert(goal.places.end(), places.begin(), places.end());
        }
    }
}

}  // namespace

TouchPlaces find_touches(const ProblemCheck& check, const Goal& goal) {
    return TouchSearch(check, goal).places();
}

Problem with_touches(Problem problem) {
    const ProblemCheck check(problem);  // which asks it for no goal
    for (std::vector<Goal>* const goals : {&problem.goals_before, &problem.targets}) {
        for (Goal& goal : *goals) {
            find_places(check, goal);
        }
    }
    find_places(check, problem.goal);
    return problem;
}

}  // namespace downwash
