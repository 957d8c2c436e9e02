#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/thrust_stand/stand_results.hpp"

// Files of thrust stands: tables or logs of one rotor with its motor, with columns in units of their own.

namespace downwash {

/// Reads files of one rotor. They are delimited text in any dialect of CsvReader, with a thrust and any of throttle,
/// torque, speed, voltage, current, power and time, or with CT, CP and RPM. A column is known by its name, and its unit
/// stands behind that: "Thrust (kgf)", "thrust_g", "Torque [N m]". Signs of thrust and torque do not count.
///
/// Rows count as they are, or, in a log with time and throttle, as the means over the later halves of stretches of
/// equal throttle. Ratios are those of sums over these measurements, so that larger thrusts count more. Measurements at
/// equal throttle give the scatter, steps of the throttle in a log the lag.
/// @pre there are files   @throws InputError with "file:line:column: what is wrong" for each error of a file
[[nodiscard]] DOWNWASH_EXPORT ThrustStand read_thrust_stand(const std::vector<std::filesystem::path>& files,
                                                            const ThrustStandSettings& settings = {});

/// The same of texts: names and contents.
[[nodiscard]] DOWNWASH_EXPORT ThrustStand parse_thrust_stand(
    const std::vector<std::pair<std::string, std::string>>& texts, const ThrustStandSettings& settings = {});

/// The keys of a robot file that a thrust stand gives, `rotors:` and `uncertainty:`, as YAML with comments.
[[nodiscard]] DOWNWASH_EXPORT std::string thrust_stand_yaml(const ThrustStand& stand);

}  // namespace downwash
