#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/grids/factor_grid.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// Reads a grid of thrust ratios from CSV; docs/grids.md describes the format.
/// @param plane of the coordinates x_m, z_m in a file that names no frame of its own
/// @throws InputError with file, line and column, what was found and what was expected
[[nodiscard]] DOWNWASH_EXPORT FactorGrid read_factor_grid(const std::filesystem::path& file,
                                                          const PlaneOfMotion& plane = {});

/// Reads a grid from the bytes of a CSV file. @param name of the file in messages
[[nodiscard]] DOWNWASH_EXPORT FactorGrid parse_factor_grid(std::string_view bytes, const std::string& name,
                                                           const PlaneOfMotion& plane = {});

/// Writes a grid as VTK ImageData (.vti) or CSV (.csv), whole or not at all. Reading the CSV gives the same grid to the
/// bit.
/// @throws InputError if the name has another ending or the file cannot be written
DOWNWASH_EXPORT void write_factor_grid(const std::filesystem::path& file, const FactorGrid& grid);

/// @throws InputError if write_factor_grid could not begin to write this file
DOWNWASH_EXPORT void require_grid_writable(const std::filesystem::path& file);

/// What write_factor_grid writes to a .vti file.
[[nodiscard]] DOWNWASH_EXPORT std::string vti_text(const FactorGrid& grid);
/// What it writes to a .csv file.
[[nodiscard]] DOWNWASH_EXPORT std::string grid_csv_text(const FactorGrid& grid);

/// Larger files are rejected unread.
inline constexpr std::size_t max_grid_file_bytes = std::size_t{1} << 31U;

}  // namespace downwash
