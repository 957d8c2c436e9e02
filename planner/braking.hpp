#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/braking_parts.hpp"

namespace downwash::planning {

/// Flights that brake to a hover, wherever a vehicle is: from the reference that it follows to rest nearby, as the
/// limits of motion allow, and a hover there for stop_hold_s.
template <class Family>
class DOWNWASH_EXPORT BrakingOf {
 public:
    using Problem = typename Family::Problem;
    using FlightModel = typename Family::FlightModel;
    using FlownWorld = typename Family::FlownWorld;
    using FlightState = typename Family::FlightState;
    using FlightJob = typename Family::FlightJob;
    using FlightLeg = typename Family::FlightLeg;
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using Plan = typename Family::Plan;
    using Fleet = FleetOf<Family>;
    using Parts = BrakingPartsOf<Family>;
    using MapAround = typename Parts::MapAround;

    /// @param problem whose rules count: bounds, obstacles, margin and, with an uncertainty, its worlds
    /// @param map_around asked for the places of the ways to brake that are flown next
    /// @param worlds in which stops have to be safe beside the nominal one   @param threads at least 1
    /// @pre the problem outlives it
    BrakingOf(const Problem& problem, std::shared_ptr<const FlightModel> model, MapAround map_around,
              std::vector<FlownWorld> worlds, int threads = 1);

    /// A stop, and in how many of the worlds, the nominal one included, it is not safe.
    struct Stop {
        Plan plan;
        std::size_t failures = 0;
    };
    /// A vehicle in the nominal world and in each of the others, and the reference that it follows.
    struct Moment {
        ReferencePoint reference;
        Fleet fleet;
    };
    /// A vehicle that is the same in all worlds.
    [[nodiscard]] Moment moment_of(const ReferencePoint& reference, const FlightState& vehicle) const;

    /// The first of some ways to brake that is safe: it touches nothing in any world, and in the nominal one it comes
    /// to rest and keeps the margin, if the vehicle has it where it begins. Where none is, the one that fails in the
    /// fewest worlds, of those that end at a clear place if there is one; nothing if all of them leave the bounds.
    [[nodiscard]] std::optional<Stop> best_stop(Moment moment);

    /// The same for many moments, whose flights are side by side. @throws WorkStopped when it is over before
    [[nodiscard]] std::vector<std::optional<Stop>> best_stops(std::vector<Moment> moments,
                                                              const StopCondition& is_over = {});

 private:
    /// A way to brake that does not leave the bounds.
    struct Try {
        Plan plan;
        typename Parts::Hover hover;
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
    /// Some tries of a moment, to be flown in the worlds from the first to before the last; 0 is the nominal one.
    struct Batch {
        const Tries* of;
        std::span<Try> tries;
        std::size_t first_world, last_world;
    };
    [[nodiscard]] Tries all_tries(Moment moment) const;
    void leave_out_near_rests(Tries& tries) const;
    /// Adds where ways to brake lead from and to.
    void add_places(std::span<const Try> tries, const Moment& from, std::vector<Configuration>& places) const;
    [[nodiscard]] const FlownWorld* world(std::size_t number) const;
    /// The next tries of a moment, up to so many.
    [[nodiscard]] Batch next(Tries& tries, std::size_t count, std::size_t first_world) const;
    void try_the_others(Tries& tries);
    /// Flies batches side by side.
    void fly(std::span<const Batch> batches);

    const Problem& problem_;
    std::shared_ptr<const FlightModel> model_;
    std::vector<FlownWorld> worlds_;  ///< without the nominal one
    Parts parts_;
};
using Braking = BrakingOf<Plane>;

}  // namespace downwash::planning
