#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/csv_facts.hpp"
#include "downwash/base/export.hpp"

namespace downwash {

/// One measured thrust near a surface, as a ratio to the same rotor's thrust far from it at the same command.
struct Measurement {
    double z_over_r = 0;             ///< distance from the rotor plane to the surface in rotor radii
    double thrust_ratio = 0;         ///< K
    double tilt_deg = 0;             ///< angle of the rotor's axis from the normal of the surface
    std::optional<double> sigma;     ///< standard deviation of thrust_ratio, where it is known
    std::size_t line = 0;            ///< line of the file
    std::vector<std::string> cells;  ///< the whole row, as written
};

/// The content of a file of measurements.
struct DOWNWASH_EXPORT Measurements {
    std::vector<std::string> columns;  ///< names of `cells`
    std::vector<Measurement> points;   ///< points in the order of the file
    CsvFacts csv = {};                 ///< how the whole file looks

    /// The position of a column in `columns`, as find_column() finds it; empty if there is none of that name.
    [[nodiscard]] std::optional<std::size_t> index(std::string_view column) const;
    /// The distinct entries of a column, in the order of their first appearance; none without such a column.
    [[nodiscard]] std::vector<std::string> entries(std::string_view column) const;
    /// The points that have this entry in that column; none without such a column.
    [[nodiscard]] Measurements with(std::string_view column, std::string_view entry) const;
};

/// What is wrong with an entry of a column `surface`: "has the surface 'cieling'; expected ground or ceiling". Empty
/// for those two and for an empty entry.
[[nodiscard]] DOWNWASH_EXPORT std::optional<std::string> surface_error(const std::string& surface);

/// Reads measurements from a CSV file in any dialect of CsvReader: a header with `z_over_r` (in
/// [1e-6, 1000]), `thrust_ratio` (in [0, 100]), optionally `sigma` (in [1e-9, 100], or empty) and `tilt_deg` (in [0,
/// 90], or empty for 0), `surface` (`ground`, `ceiling` or empty), and any others, for example `source`. At most 100000
/// rows and 16 MB.
/// @throws InputError with "file:line: what is wrong" for each error found
[[nodiscard]] DOWNWASH_EXPORT Measurements read_measurements(const std::filesystem::path& file);

/// Reads measurements from text; errors use `name` as the name of the file.
[[nodiscard]] DOWNWASH_EXPORT Measurements parse_measurements(std::string_view text, std::string_view name);

}  // namespace downwash
