#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/base/text.hpp"

namespace downwash {

/// Reads comma-separated text line by line. It skips blank lines and a byte order mark.
class DOWNWASH_EXPORT CsvLines {
 public:
    /// @param text must outlive this
    explicit CsvLines(std::string_view text);

    /// Moves to the next line that is not blank; false if there is none.
    bool next();

    /// Number of the current line, from 1.
    [[nodiscard]] std::size_t number() const noexcept { return number_; }
    /// The current line, without its end.
    [[nodiscard]] std::string_view text() const noexcept { return line_; }
    /// Whether it is a comment: its first character is `#`.
    [[nodiscard]] bool is_comment() const { return trimmed(line_).starts_with('#'); }
    /// The text of a comment. @pre is_comment()
    [[nodiscard]] std::string_view comment() const { return trimmed(line_).substr(1); }

    /// Calls take(cell, column) for every cell of the current line, without the blanks around it. The column is where
    /// the cell begins, from 1. Quotes have no meaning.
    template <class Take>
    void for_each_cell(const Take& take) const {
        for (std::size_t begin = 0; begin <= line_.size();) {
            const std::size_t end = std::min(line_.find(',', begin), line_.size());
            take(trimmed(line_.substr(begin, end - begin)), begin + 1);
            begin = end + 1;
        }
    }

 private:
    std::string_view rest_, line_;
    std::size_t number_ = 0;
};

/// A text as a cell: one with commas, quotes or ends of lines stands in quotes (RFC 4180).
[[nodiscard]] DOWNWASH_EXPORT std::string csv_cell(const std::string& text);

}  // namespace downwash
