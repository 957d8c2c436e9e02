#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/csv_facts.hpp"
#include "downwash/base/export.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// What tables of numbers there are.
enum class DataKind { grid, effect_table, measurements, wall_measurements };

/// Name in files: "effect_table".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(DataKind kind);

/// A file of numbers as it was read.
struct DataFacts {
    std::string key;   ///< of the problem that names it, "aero.map"; empty for a file by itself
    std::string file;  ///< as the program finds it
    DataKind kind = DataKind::grid;
    CsvFacts csv;
};

/// Every file of numbers that a problem names, each once.
[[nodiscard]] DOWNWASH_EXPORT std::vector<DataFacts> data_facts(const Problem& problem);

/// Reads a file of numbers by itself; its columns tell its kind.
/// @throws InputError with "file:line: what is wrong" for each error found
[[nodiscard]] DOWNWASH_EXPORT DataFacts read_data_file(const std::filesystem::path& file);

/// What is likely not meant about the numbers of a file: K as gains or percent, distances that are not in radii,
/// columns of a table or a grid that nothing reads. @param max_factor most that a surface may multiply thrust by
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::string> data_remarks(const DataFacts& data, double max_factor = 2);

/// The unit in which a column of such a file is read: "m", "deg", "rotor radii", or "1" for a ratio.
[[nodiscard]] DOWNWASH_EXPORT std::string_view unit_of_column(std::string_view name);

}  // namespace downwash
