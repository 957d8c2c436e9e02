#pragma once

#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/report/shown_robot.hpp"

namespace downwash {

/// A robot as one self-contained HTML file: a three-dimensional view with its centres of mass, rotors with their
/// numbers, spins and thrusts in a hover, and reach; sliders for its joints; tables. Equal inputs give equal bytes.
/// @param file it is of, as the page names it   @param warnings what is likely not meant   @pre has_pages()
[[nodiscard]] DOWNWASH_EXPORT std::string robot_page(const ShownRobot& shown, const std::string& file,
                                                     const std::vector<std::string>& warnings = {});

/// The data within that page, as JSON (`downwash/robot-report/v1`).
[[nodiscard]] DOWNWASH_EXPORT std::string robot_page_data(const ShownRobot& shown, const std::string& file,
                                                          const std::vector<std::string>& warnings = {});

}  // namespace downwash
