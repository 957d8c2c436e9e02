#include "downwash/problems/key_reference.hpp"

#include <array>
#include <cstdlib>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/campaign.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/simulation/robot_parameters.hpp"

namespace downwash {
namespace {

template <class Model>
Model with_everything();

template <>
Robot with_everything<Robot>() {
    Robot robot;
    robot.body = {{Box{}, {}}, {Cylinder{}, {}}, {Sphere{}, {}}};
    robot.uncertainty.emplace();
    return robot;
}

/// A problem in which every optional group and every shape stands once, with its defaults.
template <>
Problem with_everything<Problem>() {
    Problem problem;
    problem.goal.end_effector = EndEffectorGoal{};
    problem.goal.configuration = ConfigurationGoal{};
    problem.goal.any_of = {problem.goal};
    problem.targets = {problem.goal};
    problem.return_to.emplace().configuration.emplace();
    problem.goal.contact.emplace();
    problem.obstacles = {{"", Box{}, {}, {}},
                         {"", Cylinder{}, {}, {}},
                         {"", Sphere{}, {}, {}},
                         {"", Mesh{}, {}, {}},
                         {"", Octomap{}, {}, {}}};
    problem.robot = with_everything<Robot>();
    problem.uncertainty.emplace();
    return problem;
}

template <>
Campaign with_everything<Campaign>() {
    Campaign campaign;
    campaign.expect.resize(1);
    campaign.parameters.resize(1);
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

/// Rounded: a default in radians is a round number of degrees.
double in_file_units(const std::string& path, double value) {
    return is_in_degrees(path) ? std::strtod(to_text(value * degrees_per_radian, 6).c_str(), nullptr) : value;
}

Value in_file_units(const std::string& path, Value value) {
    if (auto* number = std::get_if<double>(&value)) {
        *number = in_file_units(path, *number);
    } else if (auto* numbers = std::get_if<std::vector<double>>(&value)) {
        for (double& element : *numbers) {
            element = in_file_units(path, element);
        }
    } else if (auto* spread = std::get_if<Spread>(&value); spread != nullptr && spread->form != Spread::Form::factor) {
        spread->low = in_file_units(path, spread->low);
        spread->high = in_file_units(path, spread->high);
    }
    return value;
}

template <class Element, class Text>
std::string list_text(const std::vector<Element>& list, const Text& text) {
    std::string all;
    for (const Element& element : list) {
        all += (all.empty() ? "" : ", ") + text(element);
    }
    return "[" + all + "]";
}

std::string text_of(const Value& value) {
    const auto number_text = [](double number) { return to_text(number, 6); };
    if (const auto* flag = std::get_if<bool>(&value)) {
        return *flag ? "true" : "false";
    }
    if (const auto* number = std::get_if<double>(&value)) {
        return number_text(*number);
    }
    if (const auto* integer = std::get_if<std::uint64_t>(&value)) {
        return std::to_string(*integer);
    }
    if (const auto* text = std::get_if<std::string>(&value)) {
        return *text;
    }
    if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
        return list_text(*numbers, number_text);
    }
    if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
        return list_text(*texts, [](const std::string& text) { return text; });
    }
    if (const auto* spread = std::get_if<Spread>(&value)) {
        return spread_text(*spread, number_text);
    }
    return std::holds_alternative<std::monostate>(value) ? "null" : "";
}

template <class Model>
std::vector<KeyReference> referenced(const ParameterTable<Model>& table) {
    std::vector<KeyReference> keys;
    for (const Parameter<Model>& parameter : table.rows()) {
        KeyReference& key = keys.emplace_back();
        key.info = static_cast<const ParameterInfo&>(parameter);
        if (parameter.required || parameter.exclusive) {
            key.default_text = parameter.required ? "required" : "one of its group";
        } else if (parameter.get) {
            const std::string& path = parameter.path;
            key.default_value = in_file_units(path, parameter.get(in_groups(table, path), element_of(path)));
            key.default_text =
                (key.info.default_of.empty() ? "" : "that of " + std::string(key.info.default_of) + ", or ") +
                text_of(*key.default_value);
        }
    }
    return keys;
}

}  // namespace

std::optional<FileKind> file_kind_named(std::string_view name) {
    if (name == "problem") {
        return FileKind::problem;
    }
    if (name == "robot") {
        return FileKind::robot;
    }
    if (name == "campaign") {
        return FileKind::campaign;
    }
    return std::nullopt;
}

const std::vector<KeyReference>& key_reference(FileKind kind) {
    static const std::vector<KeyReference> problem = referenced(problem_parameters());
    static const std::vector<KeyReference> robot = referenced(robot_parameters());
    static const std::vector<KeyReference> campaign = referenced(campaign_parameters());
    switch (kind) {
        case FileKind::robot:
            return robot;
        case FileKind::campaign:
            return campaign;
        case FileKind::problem:
            break;
    }
    return problem;
}

}  // namespace downwash
