#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/robot_commands.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/thrust_stand/thrust_stand.hpp"

namespace downwash::cli {
namespace {

std::vector<std::pair<std::string, std::string>> pairs_of(const std::vector<std::string>& given, const char* option,
                                                          const char* form) {
    std::vector<std::pair<std::string, std::string>> pairs;
    for (const std::string& text : given) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
            throw UsageError("{} is '{}': expected {}", option, excerpt(text), form);
        }
        pairs.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
    return pairs;
}

std::string text_of(const StandEstimate& estimate, const char* unit) {
    return to_text(estimate.value, 6) + " " + unit +
           (estimate.low
                ? fmt::format(", 95 % interval {} to {}", to_text(*estimate.low, 4), to_text(*estimate.high, 4))
                : "");
}

std::string file_rows(const StandFile& file) {
    const std::string name = std::filesystem::path(file.file).filename().string();
    const auto column = [](const StandColumn& one) {
        return one.quantity + " '" + excerpt(one.name) + "'" + (one.unit == "1" ? "" : " in " + one.unit);
    };
    return table_row("file",
                     fmt::format("{}: {} rows, {} steady measurements", excerpt(name), file.rows, file.measurements)) +
           table_row("", joined(file.columns, ", ", column)) +
           (file.others.empty() ? "" : table_row("", "not used: " + joined(file.others, ", ", excerpt)));
}

std::string summary(const ThrustStand& stand) {
    std::string text;
    for (const StandFile& file : stand.files) {
        text += file_rows(file);
    }
    text += table_row("thrust", to_text(stand.min_thrust_n, 4) + " to " + to_text(stand.max_thrust_n, 4) + " N");
    if (stand.thrust_coefficient_n_s2) {
        text += table_row("thrust / speed^2", text_of(*stand.thrust_coefficient_n_s2, "N s2"));
    }
    if (stand.thrust_number) {
        text += table_row("C_T", to_text(*stand.thrust_number, 4) + ", T = C_T rho n^2 D^4 with n in 1/s");
    }
    if (stand.torque_ratio_m) {
        text += table_row("torque / thrust", text_of(*stand.torque_ratio_m, "m"));
    }
    if (stand.power_coefficient_w_n1p5) {
        text += table_row("power/thrust^1.5",
                          text_of(*stand.power_coefficient_w_n1p5, "W/N^1.5") +
                              fmt::format("; measurements have {} to {}", to_text(stand.power_range->first, 4),
                                          to_text(stand.power_range->second, 4)));
    }
    if (stand.lag) {
        text += table_row(
            "lag", text_of(stand.lag->time_constant_s, "s") +
                       fmt::format("; mean of {} {} of {}", stand.lag->steps, stand.lag->is_of_rise ? "rises" : "falls",
                                   stand.lag->is_of_speed ? "the squared speed" : "the thrust"));
    }
    if (stand.thrust_scatter) {
        text +=
            table_row("scatter", fmt::format("{:.2f} % of thrust at equal throttle, 95 % interval {:.2f} to {:.2f} %",
                                             100 * stand.thrust_scatter->sd, 100 * stand.thrust_scatter->low,
                                             100 * stand.thrust_scatter->high));
    }
    return text;
}

Json estimate_json(const std::optional<StandEstimate>& estimate) {
    return estimate ? Json{{"value", estimate->value},
                           {"low", estimate->low ? Json(*estimate->low) : Json()},
                           {"high", estimate->high ? Json(*estimate->high) : Json()}}
                    : Json();
}

Json scatter_json(const std::optional<StandScatter>& scatter) {
    return scatter ? Json{{"sd", scatter->sd},
                          {"low", scatter->low},
                          {"high", scatter->high},
                          {"degrees_of_freedom", scatter->freedom}}
                   : Json();
}

Json document(const ThrustStand& stand) {
    auto files = Json::array();
    for (const StandFile& file : stand.files) {
        auto columns = Json::array();
        for (const StandColumn& column : file.columns) {
            columns.push_back({{"quantity", column.quantity}, {"name", column.name}, {"unit", column.unit}});
        }
        files.push_back({{"file", file.file},
                         {"rows", file.rows},
                         {"measurements", file.measurements},
                         {"columns", std::move(columns)},
                         {"other_columns", file.others}});
    }
    Json lag;
    if (stand.lag) {
        lag = {{"time_constant_s", estimate_json(std::optional(stand.lag->time_constant_s))},
               {"scatter_s", scatter_json(stand.lag->scatter_s)},
               {"steps", stand.lag->steps},
               {"of", stand.lag->is_of_speed ? "speed" : "thrust"},
               {"is_rise", stand.lag->is_of_rise}};
    }
    return {{"files", std::move(files)},
            {"min_thrust_n", stand.min_thrust_n},
            {"max_thrust_n", stand.max_thrust_n},
            {"thrust_coefficient_n_s2", estimate_json(stand.thrust_coefficient_n_s2)},
            {"c_t", json_of(stand.thrust_number)},
            {"torque_ratio_m", estimate_json(stand.torque_ratio_m)},
            {"power_coefficient_w_n1p5", estimate_json(stand.power_coefficient_w_n1p5)},
            {"lag", std::move(lag)},
            {"thrust_scatter", scatter_json(stand.thrust_scatter)},
            {"remarks", stand.remarks}};
}

}  // namespace

ExitCode thrust_of_stand(const RobotThrustArguments& given) {
    ThrustStandSettings settings;
    settings.columns = pairs_of(given.columns, "--column", "QUANTITY=NAME, such as thrust=Schub");
    settings.units = pairs_of(given.units, "--unit", "QUANTITY=UNIT, such as thrust=gf");
    settings.radius_m = given.radius_m;
    settings.air_density_kg_m3 = given.air_density;
    settings.hover_thrust_n = given.hover_n;
    if (given.out) {
        require_writable_result(*given.out, "--out");
    }
    const ThrustStand stand = read_thrust_stand({given.files.begin(), given.files.end()}, settings);
    const std::string yaml = thrust_stand_yaml(stand);
    if (given.out) {
        write_result(*given.out, yaml, "--out");
    }
    for (const std::string& remark : stand.remarks) {
        print_error("note: " + remark + "\n");
    }
    if (given.as_json) {
        print_json(document(stand));
        return ExitCode::done;
    }
    fmt::print("{}{}", summary(stand), given.out ? table_row("file", *given.out) : "\n" + yaml);
    return ExitCode::done;
}

}  // namespace downwash::cli
