#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// Columns of numbers, all equally long; an empty cell of the file is NaN.
struct NumberTable {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;
    std::vector<std::size_t> lines;  ///< line of the file, counted from 1, where each row stands

    [[nodiscard]] std::size_t rows() const noexcept { return columns.empty() ? 0 : columns.front().size(); }
    /// Adds a row below the others. @pre as many numbers as columns
    DOWNWASH_EXPORT void add_row(const std::vector<double>& numbers);
    /// @return nullptr when there is none of that name
    [[nodiscard]] DOWNWASH_EXPORT const std::vector<double>* find(std::string_view name) const;
};

/// The text of such a file: a line of names, then the rows. Every number is the shortest that reads back as the very
/// same; a cell of NaN is empty.
[[nodiscard]] DOWNWASH_EXPORT std::string csv_text(const NumberTable& table);

/// Reads comma separated numbers below a line of column names, such as trajectory.csv and tree.csv.
/// @param file named in messages
/// @param required names that must be among the columns
/// @throws InputError with the place of every error (twenty at most): a name missing, twice or
/// not of letters, digits and _; a row of another length,
/// a cell that is neither empty nor a finite number, more than 200 columns or 40 million cells
[[nodiscard]] DOWNWASH_EXPORT NumberTable read_number_table(std::string_view text, const std::string& file,
                                                            const std::vector<std::string>& required);

}  // namespace downwash
