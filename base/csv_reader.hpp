#pragma once

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/csv_facts.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/line_errors.hpp"
#include "downwash/base/text_encoding.hpp"

namespace downwash {

/// The position of a name among those of columns; if there is none, of the only one that differs in the case of
/// letters.
[[nodiscard]] DOWNWASH_EXPORT std::optional<std::size_t> find_column(const std::vector<std::string>& names,
                                                                     std::string_view name);

/// Reads a table of delimited text row by row: a line with the names of its columns, then rows of as many cells.
///
/// The look of the text says its dialect. Cells are separated by semicolons, tabs, commas or blanks, whichever of
/// these the line of names has first in this order (a first line such as `sep=;` decides), and may stand in quotation
/// marks (RFC 4180). Decimal signs are points, or commas if the first number that cannot be understood otherwise has
/// one; `1,234` can, and is read only where one of its two meanings is in the range of its column. Lines end with LF,
/// CR LF or CR. Comments begin with `#`, a million at most; the line of names may be one if numbers follow it directly
/// (numpy.savetxt). Lines without content, columns without a name (indices) and empty cells behind the last column are
/// skipped. Encodings are those of utf8_text. An error that all lines will have, such as decimal commas between commas,
/// is told once and ends the reading.
class DOWNWASH_EXPORT CsvReader {
 public:
    struct Limits {
        std::size_t max_rows;
        std::size_t max_columns;
    };
    struct Comment {
        std::size_t line;
        std::string_view text;  ///< behind the `#`, without the blanks around it
    };

    /// Reads up to the first row.
    /// @param bytes must outlive this, as must `errors`
    /// @throws InputError through `errors` if the bytes are not text, if there is no line of names, or if a name occurs
    /// twice
    CsvReader(std::string_view bytes, LineErrors& errors, const Limits& limits);
    CsvReader(const CsvReader&) = delete;
    CsvReader& operator=(const CsvReader&) = delete;
    ~CsvReader() = default;

    /// Names of the columns; empty for one without a name, but never for the last.
    [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
    /// The line of the names, from 1.
    [[nodiscard]] std::size_t header_line() const noexcept { return header_line_; }
    /// Where a name begins in its line, from 1.
    [[nodiscard]] std::size_t header_place(std::size_t column) const { return header_places_[column]; }
    [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const { return find_column(names_, name); }
    /// The same. If there is none, adds an error and returns 0. @param expected which columns are
    [[nodiscard]] std::size_t required(std::string_view name, std::string_view expected);
    /// What to do about columns that are not there: "; write 'z_over_r [-]' as z_over_r". Empty if nothing is known.
    [[nodiscard]] std::string remedy_without(std::initializer_list<std::string_view> missing) const;

    /// Moves to the next row of as many cells as names; false if there is none. Adds an error for every other row.
    bool next();
    /// The line where the current row begins.
    [[nodiscard]] std::size_t line() const noexcept { return line_; }
    /// The text of a cell of the current row, without quotation marks and the blanks around it. Valid until next().
    [[nodiscard]] std::string_view cell(std::size_t column) const { return cells_[column].text; }
    /// The same as a number in [low, high]. If it is none, adds an error and returns nothing.
    [[nodiscard]] std::optional<double> number(std::size_t column, double low = -std::numeric_limits<double>::max(),
                                               double high = std::numeric_limits<double>::max());
    /// Adds an error at a cell of the current row.
    void add_error(std::size_t column, const std::string& message);

    /// Tells that a column of texts is read too.
    void use(std::size_t column) { is_used_[column] = true; }

    /// The dialect, the rows so far, and the columns of which number() or use() told so far.
    [[nodiscard]] CsvFacts facts() const;

    /// All comments so far.
    [[nodiscard]] std::span<const Comment> comments() const noexcept { return comments_; }

 private:
    struct Cell {
        std::string_view text;
        std::size_t line, place;
        bool has_marks;  ///< holds doubled quotation marks
    };

    void take_header();
    void take_separator_line();
    void choose_decimal_sign();
    /// Takes comments and blank lines; false at the end.
    bool skip_to_record();
    void add_comment(std::string_view text);
    [[nodiscard]] std::string_view first_line() const;
    void drop_first_line();
    void take_record();
    Cell take_cell(std::size_t& at, std::size_t& line_begin);
    Cell take_quoted_cell(std::size_t& at, std::size_t& line_begin);
    void drop_doubled_marks();
    /// Cells up to the last that is not empty.
    [[nodiscard]] std::size_t filled_cells() const;
    void name_columns();
    void add_length_error(std::size_t count);
    [[nodiscard]] bool is_end(std::size_t at) const { return at >= rest_.size() || rest_[at] == line_end_; }
    [[nodiscard]] bool is_blank(std::size_t at) const;
    [[nodiscard]] std::size_t skip_blanks(std::size_t at) const;
    [[nodiscard]] std::optional<double> only_reading(std::string_view cell, double low, double high);

    Utf8Text text_;
    LineErrors& errors_;
    Limits limits_;
    std::string_view rest_;  ///< from the beginning of a line
    std::size_t next_line_ = 1;
    std::size_t line_ = 0;
    char line_end_ = '\n';
    char separator_ = 0;
    char decimal_sign_ = '.';
    std::size_t decimal_line_ = 0;  ///< where a number shows the sign; 0 if none does

    std::vector<std::string> names_;
    std::vector<bool> is_used_;  ///< of each column, whether it was read
    std::vector<CsvColumn> ranges_;
    std::vector<std::size_t> header_places_;
    std::size_t header_line_ = 0;
    std::vector<Comment> comments_;
    std::vector<Cell> cells_;
    std::string unmarked_;  ///< texts of the cells that hold doubled quotation marks
    std::size_t rows_ = 0;
};

}  // namespace downwash
