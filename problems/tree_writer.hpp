#pragma once

// Private to problems/.

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/base/parameter_table.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/number_text.hpp"

namespace downwash::problems {

/// A text in double quotes, whatever is in it.
inline std::string quoted(const std::string& text) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (c == '\n') {
            out += "\\n";
        } else if (byte < 0x20 || byte == 0x7f) {
            out += "\\x";
            out += digits[byte >> 4U];
            out += digits[byte & 15U];
        } else {
            out += c;
        }
    }
    return out + '"';
}

/// A path as it is seen from a folder, both of which may be reached through symbolic links.
[[nodiscard]] inline std::string seen_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path relative = std::filesystem::relative(file, folder, error);
    return error || relative.empty() ? std::filesystem::absolute(file).string() : relative.string();
}

/// Writes a model along its parameter table, two spaces a level.
template <class Model>
class TreeWriter {
 public:
    /// What is written for a file that a model refers to.
    using FileText = std::function<std::string(const Parameter<Model>& row, std::size_t index)>;

    /// @param left_out paths that are not written   @pre table and model outlive this writer
    TreeWriter(const ParameterTable<Model>& table, const Model& model, FileText file_text,
               std::vector<std::string_view> left_out = {})
        : table_(table), model_(model), file_text_(std::move(file_text)), left_out_(std::move(left_out)) {}

    [[nodiscard]] std::string written() {
        write_keys("", 0, "");
        return out_;
    }
    /// A group at the top alone, with its key.
    [[nodiscard]] std::string written(const std::string& group) {
        out_ = group + ":\n";
        write_keys(group, 0, "  ");
        return out_;
    }

 private:
    using Row = Parameter<Model>;

    /// @param first_indent stands before the first key ("- " in a list), `indent` before the others
    void write_keys(const std::string& path, std::size_t index, const std::string& indent,
                    const std::string& first_indent) {
        std::string before = first_indent;
        for (const Row* row : table_.children(path)) {
            const bool is_left_out = std::find(left_out_.begin(), left_out_.end(), row->path) != left_out_.end();
            const bool applies =
                !is_left_out && !is_without_numbers(*row, index) && (!row->applies || row->applies(model_, index));
            if (applies && (row->get || is_written(*row, index))) {
                out_ += before + std::string(last_name(row->path)) + ":";
                write_content(*row, index, indent);
                before = indent;
            }
        }
    }
    void write_keys(const std::string& path, std::size_t index, const std::string& indent) {
        write_keys(path, index, indent, indent);
    }

    /// A list of any number of numbers that has none says nothing.
    bool is_without_numbers(const Row& row, std::size_t index) const {
        if (row.kind != ParameterKind::numbers || !row.elements.empty()) {
            return false;
        }
        const Value value = row.get(model_, index);
        const auto* numbers = std::get_if<std::vector<double>>(&value);
        return numbers != nullptr && numbers->empty();
    }

    /// Groups that are switched off are written as none, those of another alternative not at all.
    bool is_written(const Row& row, std::size_t index) const {
        return (row.kind == ParameterKind::list && !row.exclusive) || row.can_be_none || row.count(model_, index) > 0;
    }

    void write_content(const Row& row, std::size_t index, const std::string& indent) {
        if (row.kind == ParameterKind::file && !std::holds_alternative<std::monostate>(row.get(model_, index))) {
            out_ += " " + quoted(file_text_(row, index)) + "\n";
        } else if (row.has_value(model_, index)) {
            out_ += " " + value_text(row, row.get(model_, index)) + "\n";
        } else if (row.has_list(model_, index)) {
            write_list(row, index, indent);
        } else if (row.count(model_, index) == 0) {
            out_ += " none\n";
        } else {
            out_ += "\n";
            write_keys(row.path, index, indent + "  ");
        }
    }

    void write_list(const Row& row, std::size_t index, const std::string& indent) {
        const std::size_t count = row.count(model_, index);
        out_ += count == 0 ? " []\n" : "\n";
        for (std::size_t i = 0; i < count; ++i) {
            write_keys(row.path + "[]", element_index(index, i), indent + "    ", indent + "  - ");
        }
    }

    static std::string number_text(const Row& row, double number) {
        return is_in_degrees(row.path) ? degrees_text(number) : to_text(number);
    }

    template <class Numbers>
    static std::string list_text(const Row& row, const Numbers& numbers) {
        return "[" + joined(numbers, ", ", [&row](double number) { return number_text(row, number); }) + "]";
    }

    static std::string value_text(const Row& row, const Value& value) {
        if (const auto* flag = std::get_if<bool>(&value)) {
            return *flag ? "true" : "false";
        }
        if (const auto* number = std::get_if<double>(&value)) {
            return number_text(row, *number);
        }
        if (const auto* number = std::get_if<std::uint64_t>(&value)) {
            return std::to_string(*number);
        }
        if (const auto* text = std::get_if<std::string>(&value)) {
            return row.kind == ParameterKind::choice ? *text : quoted(*text);
        }
        if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
            return list_text(row, *numbers);
        }
        if (const auto* points = std::get_if<std::vector<Vector3>>(&value)) {
            return "[" + joined(*points, ", ", [&row](const Vector3& point) { return list_text(row, point); }) + "]";
        }
        if (const auto* spread = std::get_if<Spread>(&value)) {
            return spread_text(*spread, [&](double number) {
                return spread->form == Spread::Form::factor ? to_text(number) : number_text(row, number);
            });
        }
        return "null";
    }

    const ParameterTable<Model>& table_;
    const Model& model_;
    FileText file_text_;
    std::vector<std::string_view> left_out_;
    std::string out_;
};

}  // namespace downwash::problems
