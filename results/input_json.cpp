#include "downwash/results/input_json.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/results/input_document.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

/// The number with six digits: the last bits of a margin may depend on the processor.
Json rounded(double value) {
    constexpr int digits = 6;
    return std::isfinite(value) ? Json(std::strtod(to_text(value, digits).c_str(), nullptr)) : Json();
}

Json degrees(double angle_rad) {
    return rounded(angle_rad * degrees_per_radian);
}

Json loop_json(double margin, LoopInput input, double arm_rad) {
    return std::isfinite(margin) ? Json{{"loop", name_of(input)}, {"arm_deg", degrees(arm_rad)}} : Json();
}

std::string separator_name(char separator) {
    return separator == '\t' ? "tab" : separator == ' ' ? "blank" : std::string(1, separator);
}

Json geometry_json(const GeometryInput& geometry) {
    const GeometryFacts& facts = geometry.facts;
    const SurfaceFacts& surface = facts.surface;
    Json json{{"key", geometry.key},
              {"obstacle", geometry.name},
              {"kind", geometry.is_mesh ? "mesh" : "octree"},
              {"file", geometry.file},
              {geometry.is_mesh ? "triangles" : "cubes", facts.element_count},
              {"low_m", facts.extent_world_m.low_m},
              {"high_m", facts.extent_world_m.high_m},
              {"surface", surface_name(surface)},
              {"pieces", surface.pieces},
              {"solid_pieces", surface.solid_pieces},
              {"open_edges", surface.open_edges}};
    json["open_place"] = surface.open_edges > 0 ? Json(surface.open_place) : Json();
    if (!geometry.is_mesh) {
        json["unknown"] = name_of(geometry.unknown);
        json["unseen_share"] = geometry.unseen_share ? Json(*geometry.unseen_share) : Json();
    }
    return json;
}

Json robot_json(const RobotInput& robot) {
    const RobotFacts& facts = robot.facts;
    Json json{{"robot", robot.name},
              {"mass_kg", rounded(facts.mass_kg)},
              {"thrust_to_weight", rounded(facts.thrust_to_weight)},
              {"reach_m", rounded(facts.reach_m)},
              {"hover_share", rounded(facts.hover_share)},
              {"hover_rotor", facts.hover_rotor + 1},
              {"hover_arm_deg", degrees(facts.hover_arm_rad)}};
    json["hovers_stably"] = facts.margins.has_value();
    const LeastMargins none{HUGE_VAL, {}, 0, HUGE_VAL, {}, 0};
    const LeastMargins& margins = facts.margins ? *facts.margins : none;
    json["gain_margin_db"] = rounded(margins.gain_margin_db);
    json["gain_margin_at"] = loop_json(margins.gain_margin_db, margins.gain_input, margins.gain_arm_rad);
    json["phase_margin_deg"] = degrees(margins.phase_margin_rad);
    json["phase_margin_at"] = loop_json(margins.phase_margin_rad, margins.phase_input, margins.phase_arm_rad);
    return json;
}

Json robot_json(const SpaceRobotInput& robot) {
    const SpaceRobotFacts& facts = robot.facts;
    Json joints_deg = Json::array();
    for (const double joint_rad : facts.hover_joints_rad) {
        joints_deg.push_back(degrees(joint_rad));
    }
    return {{"robot", robot.name},
            {"mass_kg", rounded(facts.mass_kg)},
            {"joints", facts.joints},
            {"thrust_to_weight", rounded(facts.thrust_to_weight)},
            {"reach_m", rounded(facts.reach_m)},
            {"hover_share", rounded(facts.hover_share)},
            {"hover_rotor", facts.hover_rotor + 1},
            {"hover_joints_deg", std::move(joints_deg)}};
}

Json data_json(const DataFacts& data) {
    Json columns = Json::array();
    for (const CsvColumn& column : data.csv.used) {
        Json json{{"name", column.name}, {"unit", nullptr}, {"low", nullptr}, {"high", nullptr}};
        if (column.has_numbers()) {
            json["unit"] = unit_of_column(column.name);
            json["low"] = column.low;
            json["high"] = column.high;
        }
        columns.push_back(std::move(json));
    }
    return {{"key", data.key.empty() ? Json() : Json(data.key)},
            {"file", data.file},
            {"kind", name_of(data.kind)},
            {"rows", data.csv.rows},
            {"separator", separator_name(data.csv.separator)},
            {"decimal_sign", std::string(1, data.csv.decimal_sign)},
            {"columns", std::move(columns)},
            {"other_columns", data.csv.others}};
}

template <class Facts>
Json all_json(const Facts& inputs) {
    const auto named_alone = [](Json json) {
        json["file"] = std::filesystem::path(json["file"].template get<std::string>()).filename().string();
        return json;
    };
    Json geometry = Json::array(), data = Json::array();
    for (const GeometryInput& each : inputs.geometry) {
        geometry.push_back(named_alone(geometry_json(each)));
    }
    for (const DataFacts& each : inputs.data) {
        data.push_back(named_alone(data_json(each)));
    }
    return {{"geometry", std::move(geometry)}, {"robot", robot_json(inputs.robot)}, {"data", std::move(data)}};
}

}  // namespace

std::string geometry_document(const GeometryInput& geometry) {
    return geometry_json(geometry).dump();
}

std::string robot_document(const RobotInput& robot) {
    return robot_json(robot).dump();
}

std::string robot_document(const SpaceRobotInput& robot) {
    return robot_json(robot).dump();
}

std::string data_document(const DataFacts& data) {
    return data_json(data).dump();
}

Json inputs_json(const InputFacts& inputs) {
    return all_json(inputs);
}

Json inputs_json(const SpaceInputFacts& inputs) {
    return all_json(inputs);
}

}  // namespace downwash
