#pragma once

// Private to base/.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace downwash {

/// Rows that a reader has not read yet.
struct CsvRest {
    std::string_view text;  ///< from the beginning of a line
    char line_end;
    std::size_t line;  ///< its number, from 1
};

/// What to do about columns that are not there: "; write 'z_over_r [-]' as z_over_r". Empty if nothing is known.
/// @param written names of the columns   @param missing those that are not among them
[[nodiscard]] std::string names_remedy(const std::vector<std::string>& written,
                                       const std::vector<std::string_view>& missing, const CsvRest& rest);

/// What is wrong with the decimal sign of a cell, and what to do; empty if it is not the sign.
/// @param decimal_line where a number shows the sign of the file; 0 if none does
[[nodiscard]] std::string sign_remedy(std::string_view cell, char decimal_sign, std::size_t decimal_line);

/// What a row should be like.
struct CsvShape {
    char separator;
    std::size_t columns;
    std::size_t header_line;
    bool is_first_row;
};

struct LengthError {
    std::string message;
    bool is_of_all_rows;  ///< all other rows will have it, too
};

/// What is wrong with a row of another number of cells than names, and what to do.
/// @param cells at least one   @param count how many of them count
[[nodiscard]] LengthError length_error(const std::vector<std::string_view>& cells, std::size_t count,
                                       const CsvShape& shape);

}  // namespace downwash
