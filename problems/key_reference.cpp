#include "downwash/problems/key_reference.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/campaign.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/space_problem_parameters.hpp"
#include "downwash/simulation/robot_parameters.hpp"
#include "downwash/simulation/space_robot_parameters.hpp"

namespace downwash {
namespace {

/// A model in which every group and list above a key has just begun.
template <class Model>
Model with_groups_above(const ParameterTable<Model>& table, const std::string& path) {
    Model model;
    for (std::size_t end = path.find('.'); end != std::string::npos; end = path.find('.', end + 1)) {
        const std::string_view above = std::string_view(path).substr(0, end);
        const Parameter<Model>* group = table.find(above.ends_with("[]") ? above.substr(0, end - 2) : above);
        if (group != nullptr && group->resize) {
            group->resize(model, 0, 1);
        }
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
        return "[" + joined(*numbers, ", ", number_text) + "]";
    }
    if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
        return "[" + joined(*texts, ", ") + "]";
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
            key.default_value = in_file_units(path, parameter.get(with_groups_above(table, path), 0));
            key.default_text =
                (key.info.default_of.empty() ? "" : "that of " + std::string(key.info.default_of) + ", or ") +
                text_of(*key.default_value);
        }
    }
    return keys;
}

}  // namespace

std::optional<FileKind> file_kind_named(std::string_view name) {
    const auto found = std::find(file_kind_names.begin(), file_kind_names.end(), name);
    if (found == file_kind_names.end()) {
        return std::nullopt;
    }
    return static_cast<FileKind>(found - file_kind_names.begin());
}

std::string_view out_of_plane_remark(std::string_view name) {
    constexpr std::array names{"y",        "y_m", "vy_m_s",  "tolerance_y_m", "roll",
                               "roll_deg", "yaw", "yaw_deg", "heading",       "yaw_rate_deg_s"};
    if (std::find(names.begin(), names.end(), name) == names.end()) {
        return {};
    }
    return "vehicle and arm move in a vertical plane, in which x_m and z_m are coordinates; environment.plane "
           "(origin_m, heading_deg) places it in the scene";
}

const std::vector<KeyReference>& key_reference(FileKind kind) {
    static const std::vector<KeyReference> problem = referenced(problem_parameters());
    static const std::vector<KeyReference> robot = referenced(robot_parameters());
    static const std::vector<KeyReference> campaign = referenced(campaign_parameters());
    static const std::vector<KeyReference> space_problem = referenced(space_problem_parameters());
    static const std::vector<KeyReference> space_robot = referenced(space_robot_parameters());
    switch (kind) {
        case FileKind::robot:
            return robot;
        case FileKind::campaign:
            return campaign;
        case FileKind::space_problem:
            return space_problem;
        case FileKind::space_robot:
            return space_robot;
        case FileKind::problem:
            break;
    }
    return problem;
}

}  // namespace downwash
