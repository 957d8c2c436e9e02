#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/planner/safe_stops.hpp"
#include "downwash/planner/world_flights.hpp"
#include "downwash/simulation/flight_batch.hpp"
#include "downwash/simulation/world.hpp"

namespace downwash::planning {

/// For how long a stop hovers before it counts [s].
inline constexpr double stop_hold_s = 4;

/// Flights that brake to a hover, wherever a vehicle is: from the reference that it follows to rest nearby, as the
/// limits of motion allow, and a hover there for stop_hold_s.
class DOWNWASH_EXPORT Braking {
 public:
    /// A map of the planner's own model around some places of the vehicle; nullptr: surfaces do not act.
    using MapAround = std::function<std::shared_ptr<const AeroMap>(const Bounds& places)>;

    /// @param problem whose rules count: bounds, obstacles, margin and, with an uncertainty, its worlds
    /// @param map_around asked for the places of the ways to brake that are flown next
    /// @param worlds in which stops have to be safe beside the nominal one   @param threads at least 1
    /// @pre the problem outlives it
    Braking(const Problem& problem, std::shared_ptr<const FlightModel> model, MapAround map_around,
            std::vector<FlownWorld> worlds, int threads = 1);

    /// A stop, and in how many of the worlds, the nominal one included, it is not safe.
    struct Stop {
        Plan plan;
        std::size_t failures = 0;
    };
    /// The first of some ways to brake that is safe: it touches nothing in any world, and in the nominal one it comes
    /// to rest and keeps the margin, if the vehicle has it where it begins. Where none is, the one that fails in the
    /// fewest worlds, of those that end at a clear place if there is one; nothing if all of them leave the bounds.
    /// @param fleet the vehicle in the nominal world and in each of the worlds; empty: it is the same in all of them
    [[nodiscard]] std::optional<Stop> best_stop(const Start& from, const std::vector<FlightState>& fleet = {});

    /// A vehicle, and where it is in each world.
    struct Moment {
        Start from;
        std::vector<FlightState> fleet = {};
    };
    /// The same for many moments, whose flights are side by side. @throws WorkStopped when it is over before
    [[nodiscard]] std::vector<std::optional<Stop>> best_stops(std::vector<Moment> moments,
                                                              const StopCondition& is_over = {});

 private:
    /// A way to brake that does not leave the bounds.
    struct Try {
        Plan plan;
        Goal hover;
        std::size_t failures = 0;  ///< failures in the worlds in which it was flown
    };
    /// The ways to brake from a moment, those that were flown first.
    struct Tries {
        Moment moment;
        double margin_m;
        std::vector<Try> all;
        std::size_t flown = 0;

        [[nodiscard]] bool has_safe() const;
        [[nodiscard]] bool is_open() const { return flown < all.size() && !has_safe(); }
    };
    /// Some tries of a moment, to be flown in the worlds from the first to before the last.
    struct Batch {
        const Tries* of;
        std::span<Try> tries;
        std::size_t first_world, last_world;
    };
    [[nodiscard]] Tries all_tries(Moment moment) const;
    void leave_out_near_rests(Tries& tries) const;
    [[nodiscard]] Bounds places_on(std::span<const Try> tries, const Start& from) const;
    [[nodiscard]] double kept_margin_m(const FlightState& vehicle) const;
    /// The next tries of a moment, up to so many.
    [[nodiscard]] Batch next(Tries& tries, std::size_t count, std::size_t first_world) const;
    void try_the_others(Tries& tries);
    /// Flies batches side by side.
    void fly(std::span<const Batch> batches);
    /// Later flights are with a map around these places.
    void fly_around(const Bounds& places);

    const Problem& problem_;
    std::shared_ptr<const FlightModel> model_;
    MapAround map_around_;
    std::vector<FlownWorld> worlds_;  ///< the nominal one first
    int threads_;
    std::shared_ptr<const AeroMap> map_;
    std::unique_ptr<FlightPool> pool_;  ///< flights with the map; nothing before the first flight
};

/// Where vehicles can stop as they follow plans of a problem from its start, in every world from where they are in that
/// world. Reference and way to brake are the same in all of them.
class DOWNWASH_EXPORT StopFinder {
 public:
    /// As for Braking, with one map over all places.
    StopFinder(const Problem& problem, std::shared_ptr<const FlightModel> model, std::shared_ptr<const AeroMap> map,
               std::vector<FlownWorld> worlds, int threads = 1);

    /// @param plan from the problem's start on   @throws WorkStopped when it is over before all stops are known
    [[nodiscard]] SafeStops along(const Plan& plan, const StopCondition& is_over = {});

 private:
    const Problem& problem_;
    std::shared_ptr<const FlightModel> model_;
    std::vector<FlownWorld> worlds_;  ///< without the nominal one
    Braking braking_;
    WorldFlights flights_;
    /// What is known of moments of the plan before: most of them are those of the next plan.
    struct Known {
        Braking::Moment moment;
        SafeStops::Moment stop;
    };
    std::vector<Known> known_;
};

}  // namespace downwash::planning
