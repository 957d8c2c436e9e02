#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "downwash/planner/certificate.hpp"
#include "downwash/planner/goal_sequence.hpp"
#include "downwash/search/fleet.hpp"

namespace downwash::planning {

/// What all flights of a problem with an uncertainty share.
class ProblemWorlds {
 public:
    /// @param map of the planner's own model; nullptr for none   @param options for threads and the cache of maps
    ProblemWorlds(const Problem& problem, std::shared_ptr<const FlightModel> model, const AeroMap* map,
                  const SolveOptions& options);

    /// The worlds that a search flies in, and the fleet at the end of the course before it.
    /// @throws InputError when the vehicle cannot hover at its start in some of them
    [[nodiscard]] SearchWorlds for_search(const Course& before) const;

    /// Flies a plan in worlds that nobody has seen, until it is known whether it passes. One that the caller stops in
    /// the middle of that has not passed.
    /// @param whole through all goals of the course and then to `goal`   @param attempt from 1
    [[nodiscard]] Certificate certify(const Course& before, const Plan& whole, const Goal& goal,
                                      std::uint64_t attempt) const;

 private:
    /// A fleet hovering at the problem's start; nothing for vehicles that do not stay there.
    [[nodiscard]] std::vector<std::optional<FlightState>> starts_in(const std::vector<FlownWorld>& worlds) const;
    /// Why a plan fails in each world; Rejection::none where it does not.
    [[nodiscard]] std::vector<Rejection> outcomes_of(const Course& before, const Plan& whole, const Goal& goal,
                                                     const std::vector<FlownWorld>& worlds) const;
    /// Flies a part of a plan, from a knot to another, in all jobs.
    void fly_part(std::vector<FlightJob>& jobs, const Plan& plan, std::size_t first, std::size_t last,
                  const Goal* goal) const;

    const Problem& problem_;
    std::shared_ptr<const FlightModel> model_;
    const AeroMap* map_;
    CeilingPart ceiling_;
    int threads_;
    std::stop_token stop_;
};

}  // namespace downwash::planning
