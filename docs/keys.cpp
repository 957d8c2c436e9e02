// Prints docs/keys.md: every key of problem and robot files, from the one table that also reads them.

#include <fmt/core.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/planner/problem_parameters.hpp"

using namespace downwash;

namespace {

/// A problem in which every optional group and every shape stands once, with its defaults.
Problem with_everything() {
    Problem problem;
    problem.goal.end_effector = EndEffectorGoal{};
    problem.goal.configuration = ConfigurationGoal{};
    problem.obstacles = {{"", Box{}, {}, {}},
                         {"", Cylinder{}, {}, {}},
                         {"", Sphere{}, {}, {}},
                         {"", Mesh{}, {}, {}},
                         {"", Octomap{}, {}, {}}};
    problem.robot.body = {{Box{}, {}}, {Cylinder{}, {}}, {Sphere{}, {}}};
    return problem;
}

/// The list element in which a key has a value.
std::size_t element_of(const std::string& path) {
    constexpr std::array<std::string_view, 5> shapes{".box.", ".cylinder.", ".sphere.", ".mesh.", ".octomap."};
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (path.find(shapes[i]) != std::string::npos) {
            return i;
        }
    }
    return 0;
}

/// The problem whose values of a key are its defaults: below a choice that is written as a group they are those of one
/// that has just begun.
Problem in_groups(const std::string& path) {
    Problem problem = with_everything();
    const Parameter<Problem>* group = problem_parameters().find(parent_path(path));
    if (group != nullptr && group->can_be_group) {
        group->resize(problem, 0, 1);
    }
    return problem;
}

std::string in_file_units(const std::string& path, double value) {
    return fmt::format("{:.6g}", is_in_degrees(path) ? value * degrees_per_radian : value);
}

std::string default_text(const Parameter<Problem>& parameter) {
    if (parameter.required) {
        return "required";
    }
    if (parameter.exclusive) {
        return "one of its group";
    }
    if (!parameter.get) {
        return "";
    }
    const std::string& path = parameter.path;
    const Value value = parameter.get(in_groups(path), element_of(path));
    if (const auto* flag = std::get_if<bool>(&value)) {
        return *flag ? "true" : "false";
    }
    if (const auto* number = std::get_if<double>(&value)) {
        return in_file_units(path, *number);
    }
    if (const auto* integer = std::get_if<std::uint64_t>(&value)) {
        return fmt::format("{}", *integer);
    }
    if (const auto* text = std::get_if<std::string>(&value)) {
        return *text;
    }
    if (const auto* list = std::get_if<std::vector<double>>(&value)) {
        std::string text;
        for (const double number : *list) {
            text += (text.empty() ? "" : ", ") + in_file_units(path, number);
        }
        return "[" + text + "]";
    }
    return std::holds_alternative<std::monostate>(value) ? "null" : "";
}

}  // namespace

int main() {
    fmt::print(
        "# Keys of problem and robot files\n\n"
        "Printed from the table that reads them (`cmake --build build --target docs`). Angles are degrees in files. "
        "`[]` stands for\nthe elements of a list. A robot may stand inline or in a file of its own with "
        "`schema: downwash/robot/v1`.\n\n"
        "| key | expected | default | meaning |\n| --- | --- | --- | --- |\n");
    for (const Parameter<Problem>& parameter : problem_parameters().rows()) {
        std::string meaning = parameter.description;
        if (!parameter.condition.empty()) {
            meaning += " (" + parameter.condition + ")";
        }
        fmt::print("| `{}` | {} | {} | {} |\n", parameter.path, expectation(parameter), default_text(parameter),
                   meaning);
    }
}
