#include "downwash/problems/problem_writer.hpp"

#include <algorithm>
#include <functional>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/sha256.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/number_text.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/text_checks.hpp"

namespace downwash {
namespace {

/// A text in double quotes, whatever is in it.
std::string quoted(const std::string& text) {
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

/// What is written for a file that a problem refers to.
using FileText = std::function<std::string(const Parameter<Problem>& row, std::size_t index)>;

/// Writes the groups below a key path, two spaces a level.
class Writer {
 public:
    /// @param left_out paths that are not written
    Writer(const Problem& problem, FileText file_text, std::vector<std::string_view> left_out = {})
        : problem_(problem), file_text_(std::move(file_text)), left_out_(std::move(left_out)) {}

    [[nodiscard]] std::string written() {
        write_keys("", 0, "");
        return out_;
    }

 private:
    using Row = Parameter<Problem>;

    /// @param first_indent stands before the first key ("- " in a list), `indent` before the others
    void write_keys(const std::string& path, std::size_t index, const std::string& indent,
                    const std::string& first_indent) {
        std::string before = first_indent;
        for (const Row* row : problem_parameters().children(path)) {
            const bool is_left_out = std::find(left_out_.begin(), left_out_.end(), row->path) != left_out_.end();
            const bool applies =
                !is_left_out && !is_without_numbers(*row, index) && (!row->applies || row->applies(problem_, index));
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
        const Value value = row.get(problem_, index);
        const auto* numbers = std::get_if<std::vector<double>>(&value);
        return numbers != nullptr && numbers->empty();
    }

    /// Groups that are switched off are written as none, those of another alternative not at all.
    bool is_written(const Row& row, std::size_t index) const {
        return (row.kind == ParameterKind::list && !row.exclusive) || row.can_be_none || row.count(problem_, index) > 0;
    }

    void write_content(const Row& row, std::size_t index, const std::string& indent) {
        if (row.kind == ParameterKind::file && !std::holds_alternative<std::monostate>(row.get(problem_, index))) {
            out_ += " " + quoted(file_text_(row, index)) + "\n";
        } else if (row.has_value(problem_, index)) {
            out_ += " " + value_text(row, row.get(problem_, index)) + "\n";
        } else if (row.has_list(problem_, index)) {
            write_list(row, index, indent);
        } else if (row.count(problem_, index) == 0) {
            out_ += " none\n";
        } else {
            out_ += "\n";
            write_keys(row.path, index, indent + "  ");
        }
    }

    void write_list(const Row& row, std::size_t index, const std::string& indent) {
        const std::size_t count = row.count(problem_, index);
        out_ += count == 0 ? " []\n" : "\n";
        for (std::size_t i = 0; i < count; ++i) {
            write_keys(row.path + "[]", element_index(index, i), indent + "    ", indent + "  - ");
        }
    }

    static std::string number_text(const Row& row, double number) {
        return is_in_degrees(row.path) ? problems::degrees_text(number) : to_text(number);
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

    const Problem& problem_;
    FileText file_text_;
    std::vector<std::string_view> left_out_;
    std::string out_;
};

/// A path as it is seen from a folder, both of which may be reached through symbolic links.
std::string seen_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path relative = std::filesystem::relative(file, folder, error);
    return error || relative.empty() ? std::filesystem::absolute(file).string() : relative.string();
}

}  // namespace

std::string effective_yaml(const Problem& problem, const std::filesystem::path& folder) {
    const auto path = [&](const Parameter<Problem>& row, std::size_t index) {
        return seen_from(folder, std::get<std::string>(row.get(problem, index)));
    };
    return Writer(problem, path).written();
}

void require_readable_again(const Problem& problem, const std::filesystem::path& folder) {
    std::vector<KeyError> errors;
    for_each_value(problem_parameters(), problem,
                   [&](const Parameter<Problem>& row, const std::string& key, std::size_t index) {
                       const Value value = row.get(problem, index);
                       const auto* file = std::get_if<std::string>(&value);
                       if (row.kind != ParameterKind::file || file == nullptr) {
                           return;
                       }
                       if (!is_utf8(seen_from(folder, *file))) {
                           errors.push_back({key,
                                             "has a path that is not UTF-8, and effective.yaml has to refer to "
                                             "it: rename that file or folder"});
                       }
                   });
    const std::string text = effective_yaml(problem, folder);
    const auto refuse = [&](std::size_t found, std::size_t most, const std::string& what) {
        if (found > most) {
            errors.push_back({"environment.obstacles",
                              "has " + std::to_string(found) + what + " with every default filled in: expected " +
                                  std::to_string(most) + what + " or less; obstacles may stand in a mesh"});
        }
    };
    refuse((text.size() + 1023) / 1024, problems::largest_document / 1024, " KiB");
    refuse(problems::separators_in(text), problems::most_separators, " line breaks, commas, colons and brackets");
    throw_if_any(std::move(errors));
}

std::string problem_sha256(const Problem& problem) {
    const auto digest = [&](const Parameter<Problem>& row, std::size_t index) { return row.digest(problem, index); };
    // A default, which the problem has taken over where it has an uncertainty: no flight depends on it.
    std::vector<std::string_view> left_out{"robot.uncertainty"};
    // What files had no keys for means the same without them: plans from before are still of their problem.
    if (problem.robot.controller.law.index() == 0) {
        left_out.emplace_back("robot.controller.type");
    }
    if (!problem.aero.wall.is_any()) {
        left_out.emplace_back("aero.wall");
    }
    if (!problem.robot.arm.wash) {
        left_out.emplace_back("robot.arm.wash");
    }
    const auto is_filled = [](const Obstacle& obstacle) {
        const auto* octomap = std::get_if<Octomap>(&obstacle.shape);
        return octomap != nullptr && octomap->unknown == UnknownSpace::occupied;
    };
    if (std::none_of(problem.obstacles.begin(), problem.obstacles.end(), is_filled)) {
        left_out.emplace_back("environment.obstacles[].octomap.unknown");
    }
    return sha256_hex(Writer(problem, digest, left_out).written());
}

}  // namespace downwash
