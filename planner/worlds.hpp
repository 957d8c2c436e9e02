#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/planner/certificate.hpp"
#include "downwash/planner/course.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/planner/world_flights.hpp"
#include "downwash/planner/worlds_of_search.hpp"

namespace downwash::planning {

class CertificateRecord;

/// Vehicles at the end of a flight in worlds, nothing where it failed.
template <class Family>
struct FlownFleetOf {
    decltype(Family::Plan::reference) reference;  ///< flown; empty at the start
    std::vector<std::optional<typename Family::FlightState>> vehicles;
    std::vector<std::size_t> lost_on;  ///< in space: the goal, from 0, on the way to which each missing one was lost
};
using FlownFleet = FlownFleetOf<Plane>;

/// Whether what a fleet has flown is the beginning of a plan.
template <class Family>
[[nodiscard]] bool is_flown(const FlownFleetOf<Family>& fleet, const typename Family::Plan& plan) {
    const auto& flown = fleet.reference;
    return flown.size() <= plan.reference.size() &&
           std::equal(flown.begin(), flown.end(), plan.reference.begin(),
                      [](const auto& a, const auto& b) { return a.tick == b.tick && a.point == b.point; });
}

/// Certificates of later attempts are flown in worlds of their own.
inline constexpr std::uint64_t worlds_per_attempt = 1'000'000;
/// The worlds of screenings are none of any certificate.
inline constexpr std::uint64_t first_screening = std::uint64_t{1} << 32U;

/// Told now and then in how many worlds a plan was flown, and in how many it failed.
using WorldCounter = std::function<void(std::uint64_t worlds, std::uint64_t failures)>;

/// The worlds that every edge of a search has to survive beside the nominal one. @pre the problem has an uncertainty
[[nodiscard]] std::vector<FlownWorld> search_worlds(const Problem& problem);

/// The worlds of a search and the certificates of its plans.
class DOWNWASH_EXPORT ProblemWorlds {
 public:
    /// Vehicles of a search are flown in the planner's own model, those of certificates with all surfaces.
    /// @pre problem outlives it, and has an uncertainty
    ProblemWorlds(const Problem& problem, const PlannerModel& model, const SolveOptions& options);

    /// The worlds that a search flies in, and the fleet at the end of the course before it.
    /// @throws InputError when the vehicle cannot hover at its start in some of them
    [[nodiscard]] SearchWorlds for_search(const Course& before);

    /// Worlds in which a plan failed after the course, with the vehicle there at the end of the course.
    [[nodiscard]] std::vector<Counterexample> counterexamples(const Certificate& certificate, const Course& before);

    /// Flies a plan through all goals in worlds that nobody has seen, until it is known whether it passes. One that
    /// is_over ends in the middle of that has not passed.
    /// @param attempt from 1
    [[nodiscard]] Certificate certify(const Plan& whole, std::uint64_t attempt, const StopCondition& is_over,
                                      const WorldCounter& counter = {});

    /// Flies a plan to the next goal in the same way, in worlds apart: from the vehicles that the course left there. It
    /// passes where it probably fails no more often than an equal share for each goal allows. Nothing is claimed of
    /// such a plan, so this takes nothing from the error that all certificates share, and all screenings have the same
    /// worlds.
    /// @param part from the end of the course
    [[nodiscard]] Certificate screen(const Course& before, const Plan& part, const StopCondition& is_over,
                                     const WorldCounter& counter = {});

    /// How many goals the problem has.
    [[nodiscard]] std::size_t goals() const noexcept { return flights_.goals().size(); }

 private:
    [[nodiscard]] WorldFlights& own_flights() noexcept { return in_free_air_ ? *in_free_air_ : flights_; }
    /// Nothing for worlds in which the vehicle cannot hover at its start, or fly the course.
    [[nodiscard]] VehiclesOf<Plane> vehicles_after(const Course& before, std::span<const FlownWorld> worlds);
    [[nodiscard]] FlownWorld world(std::uint64_t index) const;

    /// Flights of one plan for a certificate or a screening.
    struct Test {
        const Plan& whole;
        std::size_t visits;         ///< first goals of the problem that it goes through
        std::uint64_t first_world;  ///< index
        /// Flies it in worlds that follow the first one. @param number of the first of them, from 0
        std::function<std::vector<WorldFlight>(std::uint64_t number, std::span<const FlownWorld> worlds)> fly;
    };
    [[nodiscard]] bool fly_for_certificate(const Test& test, const StopCondition& is_over, const WorldCounter& counter,
                                           CertificateRecord& record);
    [[nodiscard]] Certificate tested(const Test& test, const StopCondition& is_over, const WorldCounter& counter,
                                     CertificateRecord record);
    /// The fleet at the end of a course in so many first worlds of screenings, or more.
    [[nodiscard]] const FlownFleet& screened(const Course& course, std::uint64_t worlds, const StopCondition& is_over);
    /// Flies a plan again in worlds in which it came nearest to an obstacle, and notes what comes of it: closely, and
    /// in some of them around the nearest moment with direct aerodynamics.
    void look_closely(const Plan& whole, std::size_t visits, std::vector<WorldSample>& samples,
                      const StopCondition& is_over);
    /// @param job start and world   @param sample what comes of it
    void fly_directly(const Plan& whole, std::span<const Goal> goals, const FlightJob& job, WorldSample& sample,
                      const StopCondition& is_over) const;
    /// @param job flown along the moments of the plan
    void fly_directly_where_nearest(const Plan& whole, std::span<const Goal> goals, const Plan& moments,
                                    const FlightJob& job, WorldSample& sample, const StopCondition& is_over) const;

    const Problem& problem_;
    WorldFlights flights_;                       ///< with surfaces; clearances are estimates
    WorldFlights close_flights_;                 ///< the same with better clearances
    std::unique_ptr<WorldFlights> in_free_air_;  ///< in the planner's own model, where it knows of none
    int threads_;
    std::vector<FlownFleet> fleets_;  ///< in the first worlds of screenings, by the number of goals that were visited
};

/// The goal on whose way the flights of a plan failed most often, from 0; of several the last. Empty if none failed.
[[nodiscard]] std::optional<std::size_t> weakest_part(const Certificate& certificate);

}  // namespace downwash::planning
