#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash {

/// The answer to a problem of a family.
template <class Family>
using SolutionOf = std::conditional_t<std::is_same_v<Family, planning::Space>, SpaceSearchResult, Solution>;

/// What has changed in a problem since the last plan.
template <class Family>
struct SceneChangeOf {
    using Goal = typename Family::Goal;

    std::vector<Obstacle> put;         ///< obstacles to add; a named one replaces the obstacle of that name
    std::vector<std::string> removed;  ///< names of obstacles to remove
    std::optional<Goal> goal;          ///< replaces all goals that were not visited yet
};
using SceneChange = SceneChangeOf<planning::Plane>;
using SpaceSceneChange = SceneChangeOf<planning::Space>;

/// What a vehicle in the air should do.
enum class Advice : std::uint8_t {
    keep,    ///< fly the rest of the last plan: it is safe in the scene as it is now
    follow,  ///< fly a new plan to the goal
    stop,    ///< brake and hover: that is safe
    none,    ///< nothing is known to be safe, and a collision may be ahead; brake in the way that fails in the fewest
             ///< worlds
};

/// Name as in messages: "keep".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(Advice advice);

/// What to fly from a given moment on.
template <class Family>
struct AnswerOf {
    using Plan = typename Family::Plan;

    Advice advice = Advice::none;
    /// The plan from the start on, its first knot at tick 0. With `none`, if every braking manoeuvre leaves the bounds,
    /// it is the rest of the last plan.
    Plan plan;
    double cost = 0;  ///< cost of the flight with direct aerodynamics, by the problem's objective; `keep` and `follow`
    double after_wall_s = 0;                     ///< since replan() was called
    std::optional<SolutionOf<Family>> solution;  ///< what the search found; `follow` only
};
using Answer = AnswerOf<planning::Plane>;
using SpaceAnswer = AnswerOf<planning::Space>;

/// How to replan. Its functions must not throw.
template <class Family>
struct ReplanOptionsOf {
    /// Wall time of the whole call [s], at most 10^6, and iterations of the search, at most 10^15. With iterations
    /// alone the result does not depend on how fast the machine is.
    std::optional<double> time_limit_s;
    std::optional<std::uint64_t> max_iterations;
    std::stop_token stop;  ///< ends the call early, once it is known how to stop
    /// Called by replan()'s thread with each answer that is better than the one before; the first one is
    /// safe immediately.
    std::function<void(const AnswerOf<Family>&)> on_answer;
};
using ReplanOptions = ReplanOptionsOf<planning::Plane>;
using SpaceReplanOptions = ReplanOptionsOf<planning::Space>;

/// Replans for a vehicle in flight. It keeps scene, model, map, plan and what the last search found between calls, so
/// that a new answer takes little time: maps are evaluated again only where the scene has changed, and a search begins
/// with the rest of the last plan and with configurations from which the last tree grew.
///
/// replan() and solve() are for one thread at a time; latest() may be called from any thread at any time.
template <class Family>
class DOWNWASH_EXPORT PlannerOf {
 public:
    using Problem = typename Family::Problem;
    using Start = typename Family::Start;
    using Goal = typename Family::Goal;
    using FlightModel = typename Family::FlightModel;
    using Effects = typename Family::Effects;
    using Configuration = typename Family::Configuration;
    using Plan = typename Family::Plan;
    using FlownWorld = typename Family::FlownWorld;
    using Solution = SolutionOf<Family>;
    using SolveOptions = SolveOptionsOf<Family>;
    using SceneChange = SceneChangeOf<Family>;
    using Answer = AnswerOf<Family>;
    using ReplanOptions = ReplanOptionsOf<Family>;

    /// @param options as for solve(); its map, stop token and known plan are not used
    /// @throws InputError when the problem cannot be planned
    explicit PlannerOf(const Problem& problem, SolveOptions options = {});
    ~PlannerOf();
    PlannerOf(const PlannerOf&) = delete;
    PlannerOf& operator=(const PlannerOf&) = delete;

    /// Plans from the problem's start, and keeps the plan. Targets in any order then have the order of the plan, and
    /// an energy budget is dropped: replan() does not know what the vehicle has left of it.
    const Solution& solve(std::stop_token stop = {});

    /// Applies the changes and advises what to do from `start` on. It looks for a safe stop first, then checks whether
    /// the rest of the last plan still holds, then searches for a better plan. With an uncertainty, a new plan is
    /// certified and replaces the rest of the last plan even if it costs more, since that has flown in the worlds of
    /// the search only. The plan of the last answer, if it leads to the goal, becomes the last plan.
    /// @param start the whole vehicle at the moment from which the answer counts; see start_of() and state_at()
    /// @param tick of the last plan at that moment
    /// @throws InputError, with nothing changed, when the problem with the changes has errors apart from its start, or
    /// a limit is out of range
    Answer replan(const Start& start, std::int64_t tick, const SceneChange& change, const ReplanOptions& options = {});

    /// Uses a plan that was made earlier, from the problem's start to its goals, as the last plan.
    void adopt(const Plan& plan) { plan_ = plan; }

    /// The best answer so far to the last call of replan(); empty before its first answer.
    [[nodiscard]] std::optional<Answer> latest() const;

    /// The vehicle as it will be some ticks later, by the planner's own model without noise.
    /// @param plan that it follows from its start on
    [[nodiscard]] Start predicted(const Start& start, const Plan& plan, std::int64_t ticks) const;

    /// The problem as it is now: with all changes, from the last start to the goals that are left.
    [[nodiscard]] const Problem& problem() const noexcept { return problem_; }
    [[nodiscard]] const FlightModel& model() const noexcept { return *model_; }
    /// Shares ownership of the model; a change of the scene makes another one.
    [[nodiscard]] std::shared_ptr<const FlightModel> shared_model() const noexcept { return model_; }
    /// The map, or the volumes, of the scene as it was when they were last needed; nullptr before.
    [[nodiscard]] const Effects* map() const noexcept { return map_.get(); }
    /// The last plan to the goal; empty before there is one.
    [[nodiscard]] const std::optional<Plan>& plan() const noexcept { return plan_; }

 private:
    struct Call;

    void apply(const SceneChange& change);
    void drop_visited_goals(std::int64_t tick);
    [[nodiscard]] bool certifies() const;
    [[nodiscard]] std::vector<FlownWorld> worlds() const;
    void bind();
    [[nodiscard]] bool can_keep(const Plan& left, const StopCondition& is_over, double& cost) const;
    void find_better(Call& call, const Plan& left, bool has_plan);
    void search(Call& call, const Plan& left);
    void publish(Call& call, Answer answer);
    void remember(const Solution& solution);

    Problem problem_;
    SolveOptions options_;
    std::shared_ptr<const FlightModel> model_;
    std::shared_ptr<const Effects> map_;  ///< map of the scene as it is, once it was needed
    std::vector<BoundingBox> unmapped_;   ///< changes that the map does not know yet
    std::optional<Plan> plan_;
    std::vector<Configuration> places_;  ///< from which the tree of the last search grew
    std::uint32_t searches_ = 0;         ///< searches of replan() so far
    Solution solution_;
    mutable std::mutex mutex_;  ///< guards latest_
    std::optional<Answer> latest_;
};
using Planner = PlannerOf<planning::Plane>;
using SpacePlanner = PlannerOf<planning::Space>;

/// A vehicle after some ticks along a plan, through a map; rules are not checked.
/// @param vehicle at the plan's start, replaced by the one later   @param map nullptr: surfaces do not act
/// @param in the world, whose first_tick is that of the plan's start
/// @return whether it is still stable and flyable
DOWNWASH_EXPORT bool fly_along(const FlightModel& model, const AeroMap* map, const Plan& plan, std::int64_t ticks,
                               FlightState& vehicle, const FlightWorld& in = {});
/// The same in space.
DOWNWASH_EXPORT bool fly_along(const SpaceProblemModel& model, const SurfaceVolumes* volumes, const SpacePlan& plan,
                               std::int64_t ticks, AnySpaceState& vehicle, const planning::SpaceFlightWorld& in = {});

}  // namespace downwash
