#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace downwash {

/// How a table is written, and what was read of it.
struct CsvFacts {
    char separator = ',';             ///< `;`, `,`, a tab, or a space for blanks
    char decimal_sign = '.';          ///< `.` or `,`
    std::size_t rows = 0;             ///< below the line of names; 0: there is no file
    std::vector<std::string> used;    ///< columns that were read as numbers, as the file names them
    std::vector<std::string> others;  ///< the other columns with a name
};

}  // namespace downwash
