#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/csv_facts.hpp"
#include "downwash/base/export.hpp"

namespace downwash {

/// Force and moment of a wall on a vehicle that hovers beside it, divided by its thrust T.
struct WallMeasurement {
    std::string facility;                  ///< where it was measured; empty if the file does not say
    double distance_over_r = 0;            ///< from the axis of the nearest rotor to the wall, in rotor radii
    double force_over_thrust = 0;          ///< horizontal force over T
    double moment_over_thrust_radius = 0;  ///< pitch moment over T R
};

/// The content of a file of such measurements.
struct WallMeasurements {
    std::vector<WallMeasurement> points;
    CsvFacts csv;  ///< how the file looks
};

/// Reads such measurements from a CSV file in any dialect of CsvReader: a header with
/// `distance_over_r` (in [1, 1000]), `force_over_thrust` and `moment_over_thrust_radius` (in [-10, 10]), optionally
/// `facility`; other columns are ignored. At most 100000 rows and 16 MiB.
/// @throws InputError with "file:line: what is wrong" for each error found
[[nodiscard]] DOWNWASH_EXPORT WallMeasurements read_wall_measurements(const std::filesystem::path& file);

/// Reads measurements beside walls from text; errors use `name` as the name of the file.
[[nodiscard]] DOWNWASH_EXPORT WallMeasurements parse_wall_measurements(std::string_view text, std::string_view name);

}  // namespace downwash
