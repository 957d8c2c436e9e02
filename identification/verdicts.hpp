#pragma once

#include <array>
#include <string>
#include <vector>

#include "downwash/identification/identification.hpp"
#include "downwash/identification/information.hpp"
#include "downwash/identification/sought_numbers.hpp"

// Private to identification/: what is said of each number.

namespace downwash::identification {

/// The vehicle's numbers, with the reason of each that is not learned, and what flights say little of.
void add_numbers(const SoughtNumbers& sought, const std::vector<double>& vehicle, const Information& information,
                 const IdentifySettings& settings, Identification& found);
/// K near surfaces.
void add_ratios(const SoughtNumbers& sought, const SurfaceNodes& surface, const std::vector<double>& vehicle,
                const Information& information, Identification& found);
/// The wind of a flight.
void add_wind(const SoughtNumbers& sought, const std::string& flight, const std::array<double, 3>& wind,
              std::size_t index, const Information& information, const IdentifySettings& settings,
              Identification& found);
void add_noise(const PerChannel& variances, const PerChannel& counts, Identification& found);
/// What no such log tells. @param sees whether a log has what the vehicle saw
void add_left_out(const SpaceRobot& robot, bool sees, Identification& found);

}  // namespace downwash::identification
