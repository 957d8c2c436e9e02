#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/certificate.hpp"
#include "downwash/planner/course.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/planner/worlds.hpp"
#include "downwash/search/fleet.hpp"
#include "downwash/simulation/space_pool.hpp"

namespace downwash::planning {

/// The worlds of a search in space and the certificates of its plans; ProblemWorlds has those of the plane.
class SpaceProblemWorlds {
 public:
    /// Vehicles of a search are flown in the planner's own model, those of certificates with all surfaces.
    /// @pre problem outlives it, and has an uncertainty
    SpaceProblemWorlds(const SpaceProblem& problem, const PlannerModelOf<Space>& model, int threads);

    /// See ProblemWorlds.
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
    using Vehicles = std::vector<std::optional<AnySpaceState>>;

    /// A pool of flights to a goal, among surfaces or, if the planner's own model knows of none, without.
    [[nodiscard]] SpacePool& pool(std::size_t goal, bool among_surfaces);
    [[nodiscard]] SpaceWorld world(std::uint64_t index) const;
    /// Vehicles that have hovered at the start, or start there moving; nothing for those that do not stay there.
    [[nodiscard]] Vehicles starts_in(std::span<const SpaceWorld> worlds, bool among_surfaces);
    /// Moves vehicles on; jobs go on where they start, and have the touch at the end of their last leg.
    /// @param is_certificate among all surfaces, and goals are judged   @throws WorkStopped
    void advance(std::vector<SpaceFlightJob>& jobs, const SpacePlan& plan, const Way& way, bool is_certificate);
    [[nodiscard]] Vehicles vehicles_after(const CourseOf<Space>& before, std::span<const SpaceWorld> worlds);
    /// Flies a plan through the first goals of the problem. @throws WorkStopped
    [[nodiscard]] std::vector<WorldSample> fly(const SpacePlan& plan, std::size_t visits, std::uint64_t first_world,
                                               std::span<const SpaceWorld> worlds, const StopCondition& is_over);
    /// Flies a plan again in a world, with direct aerodynamics.
    void fly_directly(const SpacePlan& plan, std::size_t visits, WorldSample& sample,
                      const StopCondition& is_over) const;
    [[nodiscard]] Certificate tested(const SpacePlan& whole, std::size_t visits, std::uint64_t first_world,
                                     const StopCondition& is_over, const WorldCounter& counter,
                                     class CertificateRecord record);

    const SpaceProblem& problem_;
    PlannerModelOf<Space> model_;
    int threads_;
    std::vector<std::unique_ptr<SpaceGoalRule>> rules_;             ///< one for each goal
    std::vector<std::unique_ptr<SpacePool>> among_surfaces_, own_;  ///< one for each goal, made when first needed
    StopCondition is_over_;                                         ///< what flights ask
};

}  // namespace downwash::planning
