#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace downwash {

/// A column that was read, and the range of its numbers.
struct CsvColumn {
    std::string name;  ///< as the file has it
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    [[nodiscard]] bool has_numbers() const noexcept { return low <= high; }
};

/// How a table is written, and what was read of it.
struct CsvFacts {
    char separator = ',';             ///< `;`, `,`, a tab, or a space for blanks
    char decimal_sign = '.';          ///< `.` or `,`
    std::size_t rows = 0;             ///< below the line of names; 0: there is no file
    std::vector<CsvColumn> used;      ///< columns that were read
    std::vector<std::string> others;  ///< the other columns with a name
};

}  // namespace downwash
