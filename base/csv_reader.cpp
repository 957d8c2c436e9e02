#include "downwash/base/csv_reader.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "downwash/base/csv_dialect.hpp"
#include "downwash/base/csv_remedies.hpp"
#include "downwash/base/number_remedy.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

/// Comments take more memory than their two bytes in a file.
constexpr std::size_t max_comments = 1'000'000;

}  // namespace

CsvReader::CsvReader(std::string_view bytes, LineErrors& errors, const Limits& limits)
    : text_(utf8_text(bytes)), errors_(errors), limits_(limits), rest_(text_.view()) {
    if (!text_.error.empty()) {
        errors_.add(0, text_.error);
        errors_.throw_any();
    }
    line_end_ = line_end_of(rest_);
    take_header();
    if (header_line_ == 0) {
        errors_.add(0, "holds no table: expected a line with the names of its columns, then rows");
        errors_.throw_any();
    }
    choose_decimal_sign();
}

std::optional<std::size_t> find_column(const std::vector<std::string>& names, std::string_view name) {
    const auto place = [&names](auto found) { return static_cast<std::size_t>(found - names.begin()); };
    if (const auto found = std::find(names.begin(), names.end(), name); found != names.end()) {
        return place(found);
    }
    const auto is_meant = [name](const std::string& other) { return is_same_word(name, other); };
    const auto found = std::find_if(names.begin(), names.end(), is_meant);
    return found != names.end() && std::none_of(found + 1, names.end(), is_meant) ? std::optional(place(found))
                                                                                  : std::nullopt;
}

std::size_t CsvReader::required(std::string_view name, std::string_view expected) {
    const auto column = find(name);
    if (!column) {
        errors_.add(header_line_, "has no column " + std::string(name) + " in '" + excerpt(joined(names_, ", ")) +
                                      "': expected " + std::string(expected) + remedy_without({name}));
    }
    return column.value_or(0);
}

std::string CsvReader::remedy_without(std::initializer_list<std::string_view> missing) const {
    std::vector<std::string_view> really_missing;
    std::copy_if(missing.begin(), missing.end(), std::back_inserter(really_missing),
                 [this](std::string_view name) { return !find(name); });
    return names_remedy(names_, really_missing, {rest_, line_end_, next_line_});
}

bool CsvReader::next() {
    while (skip_to_record()) {
        take_record();
        const std::size_t count = filled_cells();
        if (count == 0) {
            continue;
        }
        if (rows_++ == limits_.max_rows) {
            errors_.add(line_,
                        "is row " + std::to_string(rows_) + ": expected at most " + std::to_string(limits_.max_rows));
            errors_.throw_any();
        }
        if (count <= names_.size() && cells_.size() >= names_.size()) {
            return true;
        }
        add_length_error(std::max(count, std::min(cells_.size(), names_.size())));
    }
    return false;
}

void CsvReader::add_length_error(std::size_t count) {
    std::vector<std::string_view> texts;
    std::transform(cells_.begin(), cells_.end(), std::back_inserter(texts), [](const Cell& cell) { return cell.text; });
    const LengthError error = length_error(texts, count, {separator_, names_.size(), header_line_, rows_ == 1});
    errors_.add(line_, error.message);
    if (error.is_of_all_rows) {
        errors_.throw_any();
    }
}

std::optional<double> CsvReader::number(std::size_t column, double low, double high) {
    is_used_[column] = true;
    const std::string_view text = cell(column);
    auto value = decimal_number(text, decimal_sign_);
    if (!value) {
        value = only_reading(text, low, high);
    }
    if (value && *value >= low && *value <= high) {
        if (decimal_line_ == 0 && text.find('.') != std::string_view::npos) {
            decimal_line_ = line_;
        }
        CsvColumn& range = ranges_[column];
        range.low = std::min(range.low, *value);
        range.high = std::max(range.high, *value);
        return value;
    }
    std::string expected = sign_remedy(text, decimal_sign_, decimal_line_);
    if (expected.empty()) {
        const bool is_limited = low > -std::numeric_limits<double>::max();
        expected =
            ": expected a " +
            (is_limited ? "number from " + to_text(low) + " to " + to_text(high) : std::string("finite number")) +
            number_remedy(text, decimal_sign_);
        const auto has_digit = [](const Cell& each) {
            return each.text.find_first_of("0123456789") != std::string_view::npos;
        };
        if (rows_ == 1 && std::none_of(cells_.begin(), cells_.end(), has_digit) && filled_cells() > 1) {
            expected += "; if this is a line of units, begin it with #";
        }
    }
    add_error(column, names_[column] + " is '" + excerpt(text) + "'" + expected);
    return std::nullopt;
}

CsvFacts CsvReader::facts() const {
    CsvFacts facts{separator_, decimal_sign_, rows_, {}, {}};
    for (std::size_t i = 0; i < names_.size(); ++i) {
        if (names_[i].empty()) {
            continue;
        }
        if (is_used_[i]) {
            facts.used.push_back(ranges_[i]);
        } else {
            facts.others.push_back(names_[i]);
        }
    }
    return facts;
}

void CsvReader::add_error(std::size_t column, const std::string& message) {
    errors_.add(cells_[column].line, cells_[column].place, message);
}

/// The number that a comma between thousands or before decimals means if the range of its column allows only one of
/// both; from there on the decimal sign is known.
std::optional<double> CsvReader::only_reading(std::string_view cell, double low, double high) {
    if (decimal_line_ != 0 || decimal_sign_ != '.' || cell.find('.') != std::string_view::npos ||
        std::count(cell.begin(), cell.end(), ',') != 1) {
        return std::nullopt;
    }
    std::string without(cell);
    std::erase(without, ',');
    const auto decimal = decimal_number(cell, ',');
    const auto thousands = decimal_number(without, '.');
    const auto is_in = [low, high](const auto& value) { return value && *value >= low && *value <= high; };
    if (is_in(decimal) == is_in(thousands)) {
        return std::nullopt;
    }
    if (is_in(decimal)) {
        decimal_sign_ = ',';
        decimal_line_ = line_;
        return decimal;
    }
    return thousands;
}

void CsvReader::take_header() {
    take_separator_line();
    const bool is_told = separator_ != 0;
    do {
        if (!skip_to_record()) {
            header_line_ = 0;
            return;
        }
        if (!is_told) {
            separator_ = separator_of(first_line());
        }
        header_line_ = next_line_;
        const std::string_view row = rest_;
        take_record();
        const std::size_t count = filled_cells();
        const bool are_numbers = std::all_of(cells_.begin(), cells_.begin() + static_cast<std::ptrdiff_t>(count),
                                             [](const Cell& cell) { return is_number(cell.text); });
        if (are_numbers && !comments_.empty() && comments_.back().line + 1 == header_line_) {
            const std::string_view behind_row = std::exchange(rest_, comments_.back().text);
            const std::size_t line_behind_row = std::exchange(next_line_, comments_.back().line);
            const char row_separator = std::exchange(separator_, separator_of(rest_));
            take_record();
            separator_ = row_separator;
            rest_ = behind_row;
            next_line_ = line_behind_row;
            if (filled_cells() == count &&
                std::none_of(cells_.begin(), cells_.end(), [](const Cell& cell) { return is_number(cell.text); })) {
                next_line_ = header_line_--;
                rest_ = row;
                comments_.pop_back();
            } else {
                rest_ = row;
                next_line_ = header_line_;
                take_record();
            }
        }
    } while (filled_cells() == 0);
    name_columns();
}

/// A first line `sep=;`, which Excel understands.
void CsvReader::take_separator_line() {
    std::string_view line = first_line();
    if (line.starts_with('"')) {
        line.remove_prefix(1);
    }
    if (line.size() >= 5 && is_same_word(line.substr(0, 4), "sep=")) {
        separator_ = line[4];
        drop_first_line();
    }
}

void CsvReader::name_columns() {
    const std::size_t count = filled_cells();
    if (count > limits_.max_columns) {
        errors_.add(header_line_, cells_[limits_.max_columns].place,
                    "more than " + std::to_string(limits_.max_columns) + " columns");
        errors_.throw_any();
    }
    for (std::size_t i = 0; i < count; ++i) {
        // pandas names an index thus when it reads what it wrote.
        const std::string name(cells_[i].text.starts_with("Unnamed: ") ? std::string_view() : cells_[i].text);
        if (!name.empty() && std::find(names_.begin(), names_.end(), name) != names_.end()) {
            add_error(i, "the column '" + excerpt(name) + "' occurs twice");
        }
        names_.push_back(name);
        header_places_.push_back(cells_[i].place);
        is_used_.push_back(false);
        ranges_.push_back({name});
    }
    errors_.throw_any();
}

void CsvReader::choose_decimal_sign() {
    if (separator_ == ',' && rest_.find('"') == std::string_view::npos) {
        return;  // a comma within a cell needs quotation marks
    }
    const std::string_view first_row = rest_;
    const std::size_t first_row_line = next_line_;
    const auto comments_before = static_cast<std::ptrdiff_t>(comments_.size());
    while (decimal_line_ == 0 && skip_to_record()) {
        take_record();
        for (const Cell& cell : cells_) {
            if (const char sign = decimal_sign_of(cell.text); sign != 0) {
                decimal_sign_ = sign;
                decimal_line_ = cell.line;
                break;
            }
        }
    }
    comments_.erase(comments_.begin() + comments_before, comments_.end());
    rest_ = first_row;
    next_line_ = first_row_line;
}

std::string_view CsvReader::first_line() const {
    return rest_.substr(0, rest_.find(line_end_));
}

void CsvReader::drop_first_line() {
    rest_.remove_prefix(std::min(first_line().size() + 1, rest_.size()));
    ++next_line_;
}

bool CsvReader::skip_to_record() {
    for (; !rest_.empty(); drop_first_line()) {
        const std::string_view line = trimmed(first_line());
        if (line.starts_with('#')) {
            add_comment(line.substr(1));
        } else if (line.starts_with("\"#")) {  // as spreadsheets write a comment with a comma
            add_comment(line.substr(2, line.rfind('"') - 2));
        } else if (!line.empty()) {
            return true;
        }
    }
    return false;
}

void CsvReader::add_comment(std::string_view text) {
    if (comments_.size() == max_comments) {
        errors_.add(next_line_, "is comment " + std::to_string(max_comments + 1) + ": expected at most " +
                                    std::to_string(max_comments));
        errors_.throw_any();
    }
    comments_.push_back({next_line_, trimmed(text)});
}

bool CsvReader::is_blank(std::size_t at) const {
    const char c = rest_[at];
    return c == ' ' || (c == '\t' && separator_ != '\t') || (c == '\r' && line_end_ != '\r');
}

std::size_t CsvReader::skip_blanks(std::size_t at) const {
    while (at < rest_.size() && is_blank(at)) {
        ++at;
    }
    return at;
}

void CsvReader::take_record() {
    line_ = next_line_;
    cells_.clear();
    bool has_marks = false;
    std::size_t at = 0;
    std::size_t line_begin = 0;
    for (bool is_first = true;; is_first = false) {
        at = skip_blanks(at);
        if (separator_ == ' ' && is_end(at) && !is_first) {
            break;
        }
        const Cell cell = take_cell(at, line_begin);
        if (cells_.size() <= limits_.max_columns) {
            cells_.push_back(cell);
            has_marks = has_marks || cell.has_marks;
        }
        if (is_end(at)) {
            break;
        }
        at += separator_ == ' ' ? 0 : 1;
    }
    rest_.remove_prefix(std::min(at + 1, rest_.size()));
    ++next_line_;
    if (has_marks) {
        drop_doubled_marks();
    }
}

CsvReader::Cell CsvReader::take_cell(std::size_t& at, std::size_t& line_begin) {
    if (at < rest_.size() && rest_[at] == '"') {
        return take_quoted_cell(at, line_begin);
    }
    const std::size_t begin = at;
    while (!is_end(at) && rest_[at] != separator_ && !(separator_ == ' ' && is_blank(at))) {
        ++at;
    }
    std::size_t end = at;
    while (end > begin && is_blank(end - 1)) {
        --end;
    }
    return {rest_.substr(begin, end - begin), next_line_, begin - line_begin + 1, false};
}

CsvReader::Cell CsvReader::take_quoted_cell(std::size_t& at, std::size_t& line_begin) {
    Cell cell{{}, next_line_, at - line_begin + 1, false};
    const std::size_t begin = ++at;
    for (;; ++at) {
        if (at == rest_.size()) {
            errors_.add(cell.line, cell.place, "this quotation mark opens a cell that none closes");
            errors_.throw_any();
        }
        if (rest_[at] == line_end_) {
            ++next_line_;
            line_begin = at + 1;
        } else if (rest_[at] == '"') {
            if (at + 1 == rest_.size() || rest_[at + 1] != '"') {
                break;
            }
            cell.has_marks = true;
            ++at;
        }
    }
    cell.text = trimmed(rest_.substr(begin, at - begin));
    const std::size_t behind = skip_blanks(at + 1);
    if (!is_end(behind) && rest_[behind] != separator_ && (separator_ != ' ' || behind == at + 1)) {
        errors_.add(next_line_, behind - line_begin + 1,
                    "text follows a closing quotation mark: expected the end of the cell");
        errors_.throw_any();
    }
    at = behind;
    return cell;
}

/// A quotation mark within a quoted cell is written twice.
void CsvReader::drop_doubled_marks() {
    std::size_t size = 0;
    for (const Cell& cell : cells_) {
        size += cell.has_marks ? cell.text.size() : 0;
    }
    unmarked_.clear();
    unmarked_.reserve(size);  // so that no text moves
    for (Cell& cell : cells_) {
        if (cell.has_marks) {
            const std::size_t begin = unmarked_.size();
            for (std::size_t i = 0; i < cell.text.size(); ++i) {
                unmarked_ += cell.text[i];
                i += cell.text[i] == '"' ? 1 : 0;
            }
            cell.text = std::string_view(unmarked_).substr(begin);
        }
    }
}

std::size_t CsvReader::filled_cells() const {
    std::size_t count = cells_.size();
    while (count > 0 && cells_[count - 1].text.empty()) {
        --count;
    }
    return count;
}

}  // namespace downwash
