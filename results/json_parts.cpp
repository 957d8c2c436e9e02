#include "downwash/results/json_parts.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace downwash {

using Json = nlohmann::ordered_json;

Json json_number(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Json json_number(const std::optional<double>& value) {
    return value ? json_number(*value) : Json();
}

Json warnings_json(const std::vector<LocatedError>& warnings) {
    Json list = Json::array();
    for (const LocatedError& warning : warnings) {
        list.push_back(
            {{"file", warning.file}, {"line", warning.line}, {"column", warning.column}, {"message", warning.message}});
    }
    return list;
}

Json objective_json(const CostFunction& objective) {
    if (const auto single = objective.single()) {
        return name_of(*single);
    }
    Json weights = Json::object();
    for (const Objective each : all_objectives) {
        if (objective.weight(each) > 0) {
            weights[std::string(name_of(each))] = objective.weight(each);
        }
    }
    return weights;
}

Json touch_json(const TouchRecord& touch) {
    return {{"met", touch.is_met},
            {"touched_s", touch.touched_s > 0 ? Json(touch.touched_s) : Json()},
            {"left_s", touch.left_s > 0 ? Json(touch.left_s) : Json()},
            {"force_n", json_number(touch.force_n)},
            {"force_error_n", json_number(touch.force_error_n)},
            {"peak_force_n", json_number(touch.peak_force_n)},
            {"max_depth_m", json_number(touch.max_depth_m)},
            {"power_w", json_number(touch.power_w)}};
}

}  // namespace downwash
