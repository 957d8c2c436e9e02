#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/comparison/compared_plan.hpp"

namespace downwash {

/// What a plan does at a moment, by its reference alone.
enum class FlightPhase : std::uint8_t {
    climb,     ///< it moves, and up or down at least as fast as sideways
    transit,   ///< it moves otherwise
    approach,  ///< it moves on the last metre before a hover
    hover,     ///< it rests, half a second or longer
};
inline constexpr std::array all_flight_phases{FlightPhase::climb, FlightPhase::transit, FlightPhase::approach,
                                              FlightPhase::hover};

/// Name for people and files: "climb".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(FlightPhase phase) noexcept;

/// How far before a hover its approach begins, along the reference [m].
inline constexpr double approach_m = 1;
/// A reference slower than that rests [m/s].
inline constexpr double rest_speed_m_s = 0.02;
/// Shorter rests, such as those between two pieces of a reference, are part of a motion [s].
inline constexpr double least_hover_s = 0.5;

/// The phase of each row.
[[nodiscard]] DOWNWASH_EXPORT std::vector<FlightPhase> phases_of(const PlannedFlight& planned);

}  // namespace downwash
