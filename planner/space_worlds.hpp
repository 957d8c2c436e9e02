#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/certificate.hpp"
#include "downwash/planner/course.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/planner/worlds.hpp"
#include "downwash/planner/worlds_of_search.hpp"
#include "downwash/simulation/space_pool.hpp"

namespace downwash::planning {

/// The worlds that every edge of a search has to survive beside the nominal one. @pre the problem has an uncertainty
[[nodiscard]] DOWNWASH_EXPORT std::vector<SpaceWorld> search_worlds(const SpaceProblem& problem);

/// The worlds of a search in space and the certificates of its plans; ProblemWorlds has those of the plane.
class SpaceProblemWorlds {
 public:
    /// Vehicles of a search are flown in the planner's own model, those of certificates with all surfaces.
    /// @pre problem outlives it
    SpaceProblemWorlds(const SpaceProblem& problem, const PlannerModelOf<Space>& model, int threads);

    using Vehicles = std::vector<std::optional<AnySpaceState>>;
    /// See WorldFlights: among all surfaces.
    [[nodiscard]] Vehicles starts_in(std::span<const SpaceWorld> worlds) { return starts_in(worlds, true); }
    /// Moves vehicles along a whole plan, a leg for each piece of it; none is judged.
    void advance(std::vector<SpaceFlightJob>& jobs, const SpacePlan& plan);
    /// How a plan fares through all goals in each of the worlds, among all surfaces. @throws WorkStopped
    [[nodiscard]] std::vector<WorldSample> fly(const SpacePlan& plan, std::span<const SpaceWorld> worlds,
                                               const StopCondition& is_over);

    /// See ProblemWorlds. @pre the problem has an uncertainty
    [[nodiscard]] SearchWorldsOf<Space> for_search(const CourseOf<Space>& before);
    [[nodiscard]] std::vector<CounterexampleOf<Space>> counterexamples(const Certificate& certificate,
                                                                       const CourseOf<Space>& before);
    [[nodiscard]] Certificate certify(const SpacePlan& whole, std::uint64_t attempt, const StopCondition& is_over,
                                      const WorldCounter& counter = {});
    [[nodiscard]] Certificate screen(const CourseOf<Space>& before, const SpacePlan& part, const StopCondition& is_over,
                                     const WorldCounter& counter = {});
    [[nodiscard]] std::size_t goals() const noexcept { return problem_.goals.size(); }

    /// The way of a plan from one of its knots to the end of a hover for a goal, and the touch that follows there.
    struct Way {
        std::size_t goal, first, last;
    };

 private:
    /// A pool of flights to a goal, among surfaces or, if the planner's own model knows of none, without.
    [[nodiscard]] SpacePool& pool(std::size_t goal, bool among_surfaces);
    [[nodiscard]] SpaceWorld world(std::uint64_t index) const;
    /// Vehicles that have hovered at the start, or start there moving; nothing for those that do not stay there.
    [[nodiscard]] Vehicles starts_in(std::span<const SpaceWorld> worlds, bool among_surfaces);
    /// Moves vehicles on; jobs go on where they start, and have the touch at the end of their last leg.
    /// @param is_certificate among all surfaces, and goals are judged   @throws WorkStopped
    void advance(std::vector<SpaceFlightJob>& jobs, const SpacePlan& plan, const Way& way, bool is_certificate);
    [[nodiscard]] Vehicles vehicles_after(const CourseOf<Space>& before, std::span<const SpaceWorld> worlds);
    /// Moves vehicles on along a plan, from one of its knots to its last; nothing is left of those that fail.
    void advance(Vehicles& vehicles, const CourseOf<Space>& before, std::size_t first,
                 std::span<const SpaceWorld> worlds);
    /// Flies a plan through the first goals of the problem. @throws WorkStopped
    /// @param vehicles at a knot of it, nothing where the flight failed before; in the end those at its end
    /// @param first that knot: 0, or the one at which the hover for a goal ends
    [[nodiscard]] std::vector<WorldSample> fly_on(Vehicles& vehicles, const SpacePlan& plan, std::size_t first,
                                                  std::size_t visits, std::uint64_t first_world,
                                                  std::span<const SpaceWorld> worlds, const StopCondition& is_over);
    /// The fleet at the end of a course in so many first worlds of screenings, or more.
    [[nodiscard]] const FlownFleetOf<Space>& screened(const CourseOf<Space>& course, std::uint64_t worlds,
                                                      const StopCondition& is_over);
    /// Flies a plan through all goals again in a world, with direct aerodynamics.
    void fly_directly(const SpacePlan& plan, WorldSample& sample, const StopCondition& is_over) const;
    /// Flights of one plan for a certificate or a screening.
    struct Test {
        std::uint64_t first_world;  ///< index
        /// Flies it in worlds that follow the first one. @param number of the first of them, from 0
        std::function<std::vector<WorldSample>(std::uint64_t number, std::span<const SpaceWorld> worlds)> fly;
        /// Flies it again in one of these worlds, with direct aerodynamics; empty: no flight is.
        std::function<void(WorldSample& sample)> fly_directly = {};
    };
    [[nodiscard]] Certificate tested(const Test& test, const StopCondition& is_over, const WorldCounter& counter,
                                     class CertificateRecord record);

    const SpaceProblem& problem_;
    PlannerModelOf<Space> model_;
    int threads_;
    std::vector<std::unique_ptr<SpaceGoalRule>> rules_;             ///< one for each goal
    std::vector<std::unique_ptr<SpacePool>> among_surfaces_, own_;  ///< one for each goal, made when first needed
    std::vector<SpaceWorld> search_worlds_;
    /// By the number of goals that were visited: in the worlds of the search and in the first ones of screenings.
    std::vector<FlownFleetOf<Space>> searching_, screened_;
    std::vector<std::uint64_t> refused_;  ///< by goal: how often a way to it did not pass its screening
    StopCondition is_over_;               ///< what flights ask
};

}  // namespace downwash::planning
