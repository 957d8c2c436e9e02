#include "downwash/problems/vehicle_family.hpp"

#include <string_view>

#include "downwash/problems/campaign.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/simulation/robot_parameters.hpp"
#include "downwash/simulation/space_robot_parameters.hpp"

namespace downwash::problems {
namespace {

const YamlNode* value_of(const YamlNode& map, std::string_view name) {
    for (const auto& [key, value] : map.entries) {
        if (key->kind == YamlNode::Kind::scalar && key->text == name) {
            return value.get();
        }
    }
    return nullptr;
}

std::optional<FamilyKey> key_in(const YamlNode* map, std::string_view name, std::string path) {
    if (map != nullptr) {
        for (const auto& [key, value] : map->entries) {
            if (key->kind == YamlNode::Kind::scalar && key->text == name) {
                return FamilyKey{std::move(path), key->mark};
            }
        }
    }
    return std::nullopt;
}

std::string mixed_text(const FamilyKeys& keys, const char* what) {
    return keys.space->path + " is a key of a " + what + " in space, and " + keys.plane->path + " in line " +
           std::to_string(keys.plane->mark.line) + " one of a " + what +
           " in a vertical plane: expected keys of one kind";
}

YamlError mixed(const FamilyKeys& keys, const char* what) {
    return {keys.space->mark, mixed_text(keys, what)};
}

}  // namespace

FamilyKeys family_keys_of_robot(const YamlNode& robot) {
    FamilyKeys keys;
    for (const std::string_view group : {"multirotor", "rotors", "arm"}) {
        const YamlNode* map = value_of(robot, group);
        if (map == nullptr) {
            continue;
        }
        for (const auto& [key, value] : map->entries) {
            const std::string path = std::string(group) + "." + key->text;
            const bool is_of_plane = robot_parameters().find(path) != nullptr;
            const bool is_of_space = space_robot_parameters().find(path) != nullptr;
            if (is_of_plane != is_of_space) {
                std::optional<FamilyKey>& first = is_of_plane ? keys.plane : keys.space;
                first = first ? first : FamilyKey{path, key->mark};
            }
        }
    }
    return keys;
}

FamilyKeys family_keys_of_problem(const YamlNode& problem) {
    FamilyKeys keys;
    if (const YamlNode* environment = value_of(problem, "environment")) {
        keys.plane = key_in(environment, "plane", "environment.plane");
        keys.space = key_in(value_of(*environment, "bounds"), "y_m", "environment.bounds.y_m");
    }
    return keys;
}

template <>
std::optional<YamlError> misfit<Problem>(const std::string& path, const YamlNode& node) {
    if (path.empty()) {
        const FamilyKeys keys = family_keys_of_problem(node);
        if (keys.space) {
            return keys.plane ? mixed(keys, "problem")
                              : YamlError(keys.space->mark,
                                          "environment.bounds.y_m makes this a problem in space: expected one in a "
                                          "vertical plane, whose bounds have no y_m");
        }
    }
    if (path == "robot") {
        const FamilyKeys keys = family_keys_of_robot(node);
        if (keys.space) {
            return keys.plane ? mixed(keys, "robot")
                              : YamlError(keys.space->mark,
                                          keys.space->path +
                                              " is a key of a robot in space, and this is one in a vertical plane: "
                                              "expected a robot with multirotor.pitch_inertia_kg_m2, or a problem in "
                                              "space, which environment.bounds.y_m makes it");
        }
    }
    return std::nullopt;
}

template <>
std::optional<YamlError> misfit<SpaceProblem>(const std::string& path, const YamlNode& node) {
    if (path.empty()) {
        if (const FamilyKeys keys = family_keys_of_problem(node); keys.space && keys.plane) {
            return mixed(keys, "problem");
        }
    }
    if (path == "robot") {
        const FamilyKeys keys = family_keys_of_robot(node);
        if (keys.plane) {
            return keys.space ? mixed(keys, "robot")
                              : YamlError(keys.plane->mark,
                                          keys.plane->path +
                                              " is a key of a robot in a vertical plane, and this is one in space: "
                                              "expected a robot with multirotor.inertia_kg_m2 and arm.links, or a "
                                              "problem without environment.bounds.y_m");
        }
    }
    return std::nullopt;
}

template <>
std::optional<YamlError> misfit<Campaign>(const std::string& /*path*/, const YamlNode& /*node*/) {
    return std::nullopt;
}

}  // namespace downwash::problems
