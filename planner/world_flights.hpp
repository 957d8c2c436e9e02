#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight_batch.hpp"
#include "downwash/simulation/hover_equilibrium.hpp"

namespace downwash {

/// How a plan flies in one world.
struct WorldFlight {
    Rejection rejection = Rejection::none;  ///< `unstable` also for a vehicle that does not stay at its start
    double min_clearance_m = 0;             ///< up to where the flight ended, as well as it is found
    std::size_t goal = 0;                   ///< number of the goal that a failed flight was on the way to, or missed
    bool is_lateral_collision = false;      ///< in its plane, at the same pose, the vehicle would have touched nothing
};

/// Flies whole plans of a problem in its worlds, from the start through all goals, through the aero map and side by
/// side. A flight succeeds if it touches nothing, stays stable and flyable, and meets every goal; see docs/model.md 7
/// and 9.
class DOWNWASH_EXPORT WorldFlights {
 public:
    /// @param map of the planner's own model; nullptr for none: then surfaces do not act
    /// @param threads at least 1; nothing but the time depends on it
    /// @param clearance how well flights find their clearance; empty: they take a third less time, and their clearance
    /// is infinite
    /// @pre problem outlives it
    WorldFlights(const Problem& problem, std::shared_ptr<const FlightModel> model, std::shared_ptr<const AeroMap> map,
                 int threads = 1, std::optional<ClearanceError> clearance = {});

    ~WorldFlights() = default;
    WorldFlights(const WorldFlights&) = delete;
    WorldFlights& operator=(const WorldFlights&) = delete;

    /// Vehicles that have hovered at the problem's start (HoverEquilibria), or that start there moving; nothing for
    /// those that do not stay there.
    [[nodiscard]] std::vector<std::optional<FlightState>> starts_in(std::span<const FlownWorld> worlds);

    /// Flies a plan in each of the worlds. @param plan through the first `visits` goals of the problem
    /// @throws WorkStopped when it is over before all flights have ended
    [[nodiscard]] std::vector<WorldFlight> fly(const Plan& plan, std::size_t visits, std::span<const FlownWorld> worlds,
                                               const StopCondition& is_over = {});

    /// The same from vehicles that are known already: several plans are flown in the same worlds.
    /// @param starts of starts_in() with these worlds
    [[nodiscard]] std::vector<WorldFlight> fly_from(std::span<const std::optional<FlightState>> starts,
                                                    const Plan& plan, std::size_t visits,
                                                    std::span<const FlownWorld> worlds,
                                                    const StopCondition& is_over = {});

    /// The same for a plan that is flown up to a knot already.
    /// @param vehicles there, nothing where the flight failed; in the end those at the end of the last hover
    /// @param first that knot: 0, or one at which the hover at a goal ends
    [[nodiscard]] std::vector<WorldFlight> fly_on(std::vector<std::optional<FlightState>>& vehicles, const Plan& plan,
                                                  std::size_t first, std::size_t visits,
                                                  std::span<const FlownWorld> worlds,
                                                  const StopCondition& is_over = {});

    /// Moves vehicles along a whole plan, a leg for each piece of it; none is judged, and a flight that ended stays as
    /// it is.
    /// @param touches on its way; what comes of one changes the end of the leg before it
    void advance(std::vector<FlightJob>& jobs, const Plan& plan, std::span<const PlannedTouch> touches);

    /// The touches of a plan, hover at its last goal left out, through the first `visits` goals of the problem.
    [[nodiscard]] std::vector<PlannedTouch> touches_of(const Plan& plan, std::size_t visits) const;

    [[nodiscard]] const std::vector<Goal>& goals() const noexcept { return goals_; }
    [[nodiscard]] const FlightModel& model() const noexcept { return *model_; }

 private:
    /// Moves vehicles on along a plan, from one of its knots to another. Their job's first tick becomes what touches
    /// added to that of the plan.
    /// @param goal number of the goal at which they hover in the end; empty: they are not judged
    void advance(std::vector<FlightJob>& jobs, const Plan& plan, std::size_t first, std::size_t last,
                 std::optional<std::size_t> goal);
    /// Lets vehicles touch that hover where a touch begins.
    void touch(std::vector<FlightJob>& jobs, const PlannedTouch& touch);

    /// Flies the hover at the start in worlds without a known equilibrium.
    void hover_at_start(std::span<const FlownWorld> worlds, const std::vector<std::size_t>& without_equilibrium,
                        std::vector<std::optional<FlightState>>& starts);

    /// Whether a vehicle touches nothing and is within the flyable area.
    [[nodiscard]] bool is_clear(const FlightState& vehicle, const FlownWorld& world) const;

    /// The pool of flights to a goal, made when first needed.
    FlightPool& pool(std::size_t goal);

    const Problem& problem_;
    std::shared_ptr<const FlightModel> model_;
    std::shared_ptr<const AeroMap> map_;
    std::vector<Goal> goals_;
    int threads_;
    std::optional<ClearanceError> clearance_;
    std::unique_ptr<const HoverEquilibria> equilibria_;  ///< at the start; made when first needed
    StopCondition is_over_;                              ///< what fly() asks while it goes on
    std::vector<std::unique_ptr<FlightPool>> pools_;     ///< one for each goal
};

/// A plan and the hover at its last goal, which ends at a knot of its own.
[[nodiscard]] DOWNWASH_EXPORT Plan with_hover(const Plan& plan, const Goal& goal, const FlightModel& model);

/// The least clearance along a job whose rules find it, as well as they do [m]; infinite before its first leg.
[[nodiscard]] DOWNWASH_EXPORT double min_clearance_m(const FlightJob& job);

}  // namespace downwash
