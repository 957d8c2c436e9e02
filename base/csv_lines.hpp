#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/base/text.hpp"

namespace downwash {

/// Comma separated text, line by line: blank lines are left out, a byte order mark does not count.
class DOWNWASH_EXPORT CsvLines {
 public:
    /// @param text must outlive this
    explicit CsvLines(std::string_view text);

    /// Goes on to the next line that is not blank; false when there is none.
    bool next();

    /// Of the current line, counted from 1.
    [[nodiscard]] std::size_t number() const noexcept { return number_; }
    /// The current line, without its end.
    [[nodiscard]] std::string_view text() const noexcept { return line_; }
    /// Whether it is a comment: its first character is `#`.
    [[nodiscard]] bool is_comment() const { return trimmed(line_).starts_with('#'); }
    /// What a comment says. @pre is_comment()
    [[nodiscard]] std::string_view comment() const { return trimmed(line_).substr(1); }

    /// Calls take(cell, column) for every cell of the current line, without the blanks around it; the column is where
    /// it begins, counted from 1. There are no quotes.
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

}  // namespace downwash
