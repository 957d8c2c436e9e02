#include "downwash/report/validation_page.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "downwash/base/version.hpp"
#include "downwash/report/page_flight.hpp"
#include "downwash/report/page_scene.hpp"
#include "downwash/report/page_template.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

/// JSON knows no infinity, which stands for "no obstacles".
Json finite(const std::vector<double>& values) {
    Json list = Json::array();
    for (const double value : values) {
        list.push_back(std::isfinite(value) ? Json(value) : Json());
    }
    return list;
}

Json clearance_json(const std::optional<ClearanceOverTime>& clearance) {
    if (!clearance) {
        return {};
    }
    return {{"step_s", clearance->step_s},
            {"minimum", finite(clearance->minimum)},
            {"p01", finite(clearance->p01)},
            {"p10", finite(clearance->p10)},
            {"p50", finite(clearance->p50)}};
}

Json flights_json(const std::vector<PlayableFlight>& flights) {
    Json list = Json::array();
    for (const PlayableFlight& flight : flights) {
        list.push_back({{"world", flight.world ? Json(*flight.world) : Json()},
                        {"outcome", flight.outcome},
                        {"scene_offset_m", {flight.scene_x_m, flight.scene_z_m}},
                        {"lateral_m", flight.lateral_m},
                        {"flight", flight_json(flight.rows)}});
    }
    return list;
}

}  // namespace

std::string validation_page_data(const ValidationRecord& validation, const Problem& problem, const FlightModel& model,
                                 int threads) {
    Json page{{"schema", "downwash/validation-report/v1"},
              {"version", version()},
              {"command", validation.command},
              {"problem", problem.name},
              {"findings", Json::parse(validation.findings)},
              {"is_valid", validation.is_valid},
              {"has_flight_claims", validation.has_flight_claims},
              {"seed", validation.seed},
              {"plan", Json::parse(validation.solution_text).at("plan")},
              {"clearance", clearance_json(validation.clearance)},
              {"flights", flights_json(validation.flights)}};
    add_problem(page, problem, {}, model, threads);
    return page_data(page);
}

std::string validation_page(const ValidationRecord& validation, const Problem& problem, const FlightModel& model,
                            int threads) {
    return filled_page(validation_page_template(), validation_page_data(validation, problem, model, threads));
}

}  // namespace downwash
