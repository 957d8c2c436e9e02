#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/identify_command.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/identification/held_back.hpp"
#include "downwash/identification/identification.hpp"
#include "downwash/identification/recorded_flight.hpp"
#include "downwash/logs/log_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"

namespace downwash::cli {
namespace {

LogOptions log_options(const IdentifyArguments& given) {
    LogOptions options;
    if (given.axes) {
        options.axes = *given.axes == "ned" ? LogAxes::down : LogAxes::up;
    }
    for (const std::string& column : given.columns) {
        const std::size_t equals = column.find('=');
        if (equals == 0 || equals == std::string::npos) {
            throw UsageError("--column is '{}': expected SIGNAL=NAME, such as rotor_1=thrust_front", excerpt(column));
        }
        options.columns.emplace_back(column.substr(0, equals), column.substr(equals + 1));
    }
    return options;
}

std::vector<LoggedFlight> flights_of(const std::vector<std::string>& files, const IdentifyArguments& given,
                                     const SpaceRobot& robot) {
    std::vector<LoggedFlight> flights;
    for (const std::string& file : files) {
        const FlightLog log = read_flight_log({file}, log_options(given));
        for (const std::string& remark : log.remarks) {
            print_error("downwash: " + remark + "\n");
        }
        flights.push_back(recorded_flight(log, robot, {given.is_true_motion, given.thrust_exponent}));
        flights.back().name = file;
    }
    return flights;
}

IdentifySettings settings_of(const IdentifyArguments& given) {
    IdentifySettings settings;
    if (given.wind_sd_m_s) {
        settings.air.wind_x_m_s = settings.air.wind_y_m_s = Spread::of_sd(*given.wind_sd_m_s);
    }
    if (given.gust_m_s) {
        settings.air.gust_m_s = Spread::of_sd(*given.gust_m_s);
    }
    settings.ground_m = given.ground_m;
    settings.ceiling_m = given.ceiling_m;
    if (given.surface_data && !given.ground_m && !given.ceiling_m) {
        throw UsageError("--surface-data needs a surface: expected --ground Z or --ceiling Z");
    }
    return settings;
}

/// A flight that was held back, in worlds before and after.
struct HeldBack {
    std::string flight;
    HeldBackCoverage before, after;
};

std::vector<HeldBack> held_back_of(const IdentifyArguments& given, const SpaceRobot& robot, const SpaceRobot& learned,
                                   const Uncertainty& air) {
    std::vector<HeldBack> all;
    for (const LoggedFlight& flight : flights_of(given.held_back, given, robot)) {
        if (!flight.has_reference) {
            throw UsageError("--held-back {}: the log has no set-points of the position to fly along", flight.name);
        }
        const auto coverage = [&](const SpaceRobot& of) {
            return held_back_coverage(of, flight, air, static_cast<int>(given.worlds), given.seed);
        };
        all.push_back({flight.name, coverage(robot), coverage(learned)});
    }
    return all;
}

/// A comment over the robot file: where its uncertainty is from.
std::string heading(const IdentifyArguments& given, const Identification& found) {
    std::string text = "# " + excerpt(given.robot) + ", with an uncertainty learned by `downwash identify` from " +
                       to_text(found.duration_s, 3) + " s of flight:\n";
    for (const std::string& log : given.logs) {
        text += "#   " + excerpt(log) + "\n";
    }
    text += "# Means are differences from the numbers of this file, which its controller goes on to use.\n";
    for (const IdentifiedNumber& number : found.numbers) {
        text += number.is_learned
                    ? "#   " + number.name + ": " + to_text(number.value, 3) + " +- " + to_text(number.sd, 2) + "\n"
                    : "";
    }
    return text;
}

std::string surface_csv(const Identification& found) {
    std::string text = "# thrust ratios identified by `downwash identify`\nz_over_r,thrust_ratio,sigma,surface\n";
    for (const IdentifiedRatio& ratio : found.ratios) {
        text += to_text(ratio.z_over_r) + "," + to_text(ratio.ratio, 6) + "," + to_text(ratio.sd, 3) + "," +
                (ratio.is_ceiling ? "ceiling" : "ground") + "\n";
    }
    return text;
}

Json json_of(const HeldBackCoverage& coverage) {
    return {{"worlds", coverage.worlds},
            {"lost", coverage.lost},
            {"share_within", coverage.share_within},
            {"width_m", coverage.width_m}};
}

Json json_of(const IdentifyArguments& given, const Identification& found, const std::vector<HeldBack>& held_back) {
    Json numbers = Json::array(), winds = Json::array(), noise = Json::array(), weak = Json::array(),
         ratios = Json::array(), held = Json::array();
    for (const IdentifiedNumber& number : found.numbers) {
        Json one{{"name", number.name},
                 {"before", {{"mean", number.before}, {"sd", number.before_sd}}},
                 {"value", number.value},
                 {"sd", number.sd},
                 {"learned", number.is_learned}};
        if (!number.is_learned) {
            one["reason"] = number.reason;
        }
        numbers.push_back(std::move(one));
    }
    for (const IdentifiedWind& wind : found.winds) {
        winds.push_back(
            {{"log", wind.flight}, {"wind_m_s", wind.wind_m_s}, {"sd_m_s", wind.sd_m_s}, {"learned", wind.is_learned}});
    }
    for (const IdentifiedNoise& each : found.noise) {
        noise.push_back({{"name", each.name}, {"sd", each.sd}, {"sd_of_sd", each.sd_of_sd}});
    }
    for (const WeakDirection& direction : found.weak) {
        Json shares = Json::object();
        for (const auto& [name, share] : direction.shares) {
            shares[name] = share;
        }
        weak.push_back({{"information", direction.information}, {"shares", std::move(shares)}});
    }
    for (const IdentifiedRatio& ratio : found.ratios) {
        ratios.push_back({{"surface", ratio.is_ceiling ? "ceiling" : "ground"},
                          {"z_over_r", ratio.z_over_r},
                          {"thrust_ratio", ratio.ratio},
                          {"sd", ratio.sd}});
    }
    for (const HeldBack& each : held_back) {
        held.push_back({{"log", each.flight}, {"before", json_of(each.before)}, {"after", json_of(each.after)}});
    }
    return {{"robot", given.robot},
            {"file", given.out},
            {"duration_s", found.duration_s},
            {"converged", found.is_converged},
            {"fit", finite(found.fit)},
            {"numbers", std::move(numbers)},
            {"noise", std::move(noise)},
            {"winds", std::move(winds)},
            {"thrust_ratios", std::move(ratios)},
            {"weak", std::move(weak)},
            {"left_out", found.left_out},
            {"held_back", std::move(held)}};
}

void print_numbers(const Identification& found) {
    fmt::print("{:<34}{:>12}{:>11}{:>12}{:>11}\n", "learned", "before", "sd", "now", "sd");
    for (const IdentifiedNumber& number : found.numbers) {
        if (number.is_learned) {
            const bool is_far = std::abs(number.value - number.before) > 3 * number.before_sd;
            fmt::print("{:<34}{:>12}{:>11}{:>12}{:>11}{}\n", number.name, to_text(number.before, 3),
                       to_text(number.before_sd, 2), to_text(number.value, 3), to_text(number.sd, 2),
                       is_far ? "  more than 3 sd from before: is the robot file right?" : "");
        }
    }
    for (const IdentifiedNoise& noise : found.noise) {
        fmt::print("{:<34}{:>12}{:>11}{:>12}{:>11}\n", noise.name, "", "", to_text(noise.sd, 3),
                   to_text(noise.sd_of_sd, 2));
    }
    fmt::print("\nstays as it was\n");
    for (const IdentifiedNumber& number : found.numbers) {
        if (!number.is_learned) {
            fmt::print("  {}: {}\n", number.name, number.reason);
        }
    }
    for (const std::string& left_out : found.left_out) {
        fmt::print("  {}\n", left_out);
    }
}

void print_rest(const IdentifyArguments& given, const Identification& found, const std::vector<HeldBack>& held_back) {
    const auto of_axes = [](const auto& numbers, const auto& text) {
        return text(numbers[0]) + ", " + text(numbers[1]) + ", " + text(numbers[2]);
    };
    const auto number = [](double value) { return to_text(value, 2); };
    fmt::print("\n");
    for (const IdentifiedWind& wind : found.winds) {
        fmt::print("{}", table_row("wind of " + excerpt(std::filesystem::path(wind.flight).filename().string()),
                                   of_axes(wind.wind_m_s, number) + " +- " + of_axes(wind.sd_m_s, number) +
                                       " m/s along x, y and z"));
    }
    for (const IdentifiedRatio& ratio : found.ratios) {
        fmt::print("{}", table_row(ratio.is_ceiling ? "below the ceiling" : "over the ground",
                                   fmt::format("K = {:.3f} +- {:.3f} at z/R = {}", ratio.ratio, ratio.sd,
                                               to_text(ratio.z_over_r, 3))));
    }
    fmt::print("{}", table_row("innovations", "mean square " + to_text(found.fit, 3) + ", 1 expected"));
    const auto percent = [](double share) { return fmt::format("{:.0f} %", 100 * share); };
    const auto centimetres = [](double width_m) { return fmt::format("{:.1f}", 100 * width_m); };
    for (const HeldBack& each : held_back) {
        for (const auto& [name, coverage] : {std::pair("before", &each.before), std::pair("after", &each.after)}) {
            fmt::print("{}",
                       table_row(fmt::format("held back, {}", name),
                                 fmt::format("{} of the time within 95 % of {} worlds, {} cm wide along x, y and z{}",
                                             of_axes(coverage->share_within, percent), coverage->worlds,
                                             of_axes(coverage->width_m, centimetres),
                                             coverage->lost > 0 ? fmt::format("; {} flights lost", coverage->lost)
                                                                : std::string())));
        }
    }
    if (!found.is_converged) {
        fmt::print("{}", table_row("warning", fmt::format("no rest after {} rounds", found.iterations)));
    }
    fmt::print("{}", table_row("file", given.out));
}

}  // namespace

ExitCode identify_robot(const IdentifyArguments& given) {
    const IdentifySettings settings = settings_of(given);
    require_writable_result(given.out, "--out");
    if (given.surface_data) {
        require_writable_result(*given.surface_data, "--surface-data");
    }
    if (!is_space_robot_file(given.robot)) {
        throw UsageError(
            "{} is a robot in a plane: expected one in space, such as problems/robots/ars_lrm_space.yaml is of ars_lrm",
            excerpt(given.robot));
    }
    const SpaceRobot robot = read_space_robot(given.robot, print_warning);
    const Identification found = identify(robot, flights_of(given.logs, given, robot), settings);
    const SpaceRobot learned = learned_robot(robot, found);
    const std::vector<HeldBack> held_back = held_back_of(given, robot, learned, settings.air);
    write_result(given.out, heading(given, found) + robot_yaml(learned), "--out");
    if (given.surface_data) {
        write_result(*given.surface_data, surface_csv(found), "--surface-data");
    }
    if (given.as_json) {
        print_json(json_of(given, found, held_back));
    } else {
        print_numbers(found);
        print_rest(given, found, held_back);
    }
    return ExitCode::done;
}

}  // namespace downwash::cli
