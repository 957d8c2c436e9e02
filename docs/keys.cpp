// Prints docs/keys.md: every key of problem, robot and campaign files, from the tables that also read them.

#include <fmt/core.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/planner/problem_parameters.hpp"
#include "downwash/problems/campaign.hpp"

using namespace downwash;

namespace {

template <class Model>
Model with_everything();

/// A problem in which every optional group and every shape stands once, with its defaults.
template <>
Problem with_everything<Problem>() {
    Problem problem;
    problem.goal.end_effector = EndEffectorGoal{};
    problem.goal.configuration = ConfigurationGoal{};
    problem.goal.any_of = {problem.goal};
    problem.obstacles = {{"", Box{}, {}, {}},
                         {"", Cylinder{}, {}, {}},
                         {"", Sphere{}, {}, {}},
                         {"", Mesh{}, {}, {}},
                         {"", Octomap{}, {}, {}}};
    problem.robot.body = {{Box{}, {}}, {Cylinder{}, {}}, {Sphere{}, {}}};
    return problem;
}

template <>
Campaign with_everything<Campaign>() {
    Campaign campaign;
    campaign.expect.resize(1);
    return campaign;
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

/// The model whose values of a key are its defaults: below a choice that is written as a group they are those of one
/// that has just begun.
template <class Model>
Model in_groups(const ParameterTable<Model>& table, const std::string& path) {
    auto model = with_everything<Model>();
    const Parameter<Model>* group = table.find(parent_path(path));
    if (group != nullptr && group->can_be_group) {
        group->resize(model, 0, 1);
    }
    return model;
}

std::string in_file_units(const std::string& path, double value) {
    return fmt::format("{:.6g}", is_in_degrees(path) ? value * degrees_per_radian : value);
}

template <class Model>
std::string default_text(const ParameterTable<Model>& table, const Parameter<Model>& parameter) {
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
    const Value value = parameter.get(in_groups(table, path), element_of(path));
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
    if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
        std::string text;
        for (const std::string& element : *texts) {
            text += (text.empty() ? "" : ", ") + element;
        }
        return "[" + text + "]";
    }
    return std::holds_alternative<std::monostate>(value) ? "null" : "";
}

template <class Model>
void print_table(const ParameterTable<Model>& table) {
    fmt::print("| key | expected | default | meaning |\n| --- | --- | --- | --- |\n");
    for (const Parameter<Model>& parameter : table.rows()) {
        std::string meaning = parameter.description;
        if (!parameter.condition.empty()) {
            meaning += " (" + parameter.condition + ")";
        }
        fmt::print("| `{}` | {} | {} | {} |\n", parameter.path, expectation(parameter), default_text(table, parameter),
                   meaning);
    }
}

}  // namespace

int main() {
    fmt::print(
        "# Keys of problem, robot and campaign files\n\n"
        "Printed from the tables that read them (`cmake --build build --target docs`). Angles are degrees in files. "
        "`[]` stands for\nthe elements of a list. A robot may stand inline or in a file of its own with "
        "`schema: downwash/robot/v1`.\n\n");
    print_table(problem_parameters());
    fmt::print(
        "\n## Campaigns\n\nWhat `downwash bench run` reads ([benchmarking.md](benchmarking.md)). Limits stand for "
        "those of "
        "the problem files.\n\n");
    print_table(campaign_parameters());
}
