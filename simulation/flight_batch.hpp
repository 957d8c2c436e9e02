#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash {

/// One segment of a flight that is planned, and what came of it.
struct FlightLeg {
    ReferenceSegment segment;
    SegmentFlight flight = {};  ///< as fly() reports it; zero ticks when the leg was not reached
    FlightState end = {};       ///< the vehicle at its end, or where it was refused
};

/// A flight along one or more segments, each beginning where the one before ended.
struct FlightJob {
    FlightState start;
    std::vector<FlightLeg> legs;  ///< at least one
    /// In the last so many ticks of the last leg, the state before the first of them included, the goal has to be met;
    /// otherwise the flight is refused as goal_missed. 0: no goal.
    std::int64_t judged_ticks = 0;

    /// The leg on which the flight ended early; nullptr when it did not.
    [[nodiscard]] DOWNWASH_EXPORT const FlightLeg* refused_leg() const noexcept;
    /// Why the flight ended early.
    [[nodiscard]] Rejection rejection() const noexcept {
        return refused_leg() != nullptr ? refused_leg()->flight.rejection : Rejection::none;
    }
    /// The vehicle at the end of an accepted flight.
    [[nodiscard]] const FlightState& end() const noexcept { return legs.back().end; }
};

/// Instructions that the flights of a batch are computed with. The results are the same to the last bit.
enum class Instructions : std::uint8_t {
    baseline,  ///< what every processor of the architecture has
    avx2,      ///< x86-64 only
    avx512,    ///< x86-64 only: AVX-512 F
};

/// Those that this build and this processor have, the widest last.
[[nodiscard]] DOWNWASH_EXPORT std::span<const Instructions> known_instructions() noexcept;
/// The widest of them.
[[nodiscard]] inline Instructions best_instructions() noexcept {
    return known_instructions().back();
}

/// Flies jobs side by side: in the lanes of wide registers, and on several threads. Every job comes out exactly as
/// fly() flies its legs one after the other, whatever the instructions and the number of threads. A lane whose flight
/// ends takes on the next job.
class DOWNWASH_EXPORT FlightCrew {
 public:
    /// @param map,rules as for fly(); rules.is_over is asked from all threads
    /// @param goal of jobs with judged_ticks; may be nullptr when there are none
    /// @param threads at least 1, the calling one included; the others wait between batches
    /// @pre the referred objects outlive the crew, and `instructions` are there
    FlightCrew(const FlightModel& model, const AeroMap* map, FlightRules rules, const Goal* goal, int threads = 1,
               Instructions instructions = best_instructions());
    ~FlightCrew();
    FlightCrew(const FlightCrew&) = delete;
    FlightCrew& operator=(const FlightCrew&) = delete;

    /// Not to be called from two threads at once.
    void fly(std::span<FlightJob> jobs);

    /// From its next batch on flies with so many of its threads, at least 1, the calling one included. May be called
    /// from any thread, while others fly too.
    void use_threads(int threads);

    /// As given to the constructor.
    [[nodiscard]] const FlightRules& rules() const noexcept;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace downwash
