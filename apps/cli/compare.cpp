#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/base/files.hpp"
#include "downwash/base/version.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/compare_command.hpp"
#include "downwash/cli/comparison_text.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/comparison/compared_plan.hpp"
#include "downwash/comparison/log_comparison.hpp"
#include "downwash/logs/log_reader.hpp"
#include "downwash/problems/any_problem.hpp"
#include "downwash/report/comparison_page.hpp"
#include "downwash/report/run_page.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/results/space_solution_file.hpp"

namespace downwash::cli {
namespace {

constexpr char findings_name[] = "comparison.json";
constexpr char page_name[] = "comparison.html";
constexpr std::uint64_t usual_worlds = 32, most_worlds = 10'000;

LogOptions log_options(const CompareLogArguments& given) {
    LogOptions options;
    if (given.format) {
        constexpr std::array names{"ulog", "dataflash", "rosbag", "csv"};
        options.format =
            all_log_formats[static_cast<std::size_t>(std::ranges::find(names, *given.format) - names.begin())];
    }
    if (given.axes) {
        options.axes = *given.axes == "ned" ? LogAxes::down : LogAxes::up;
    }
    if (given.time_unit) {
        options.time_unit_s = *given.time_unit == "s"    ? 1
                              : *given.time_unit == "ms" ? 1e-3
                              : *given.time_unit == "us" ? 1e-6
                                                         : 1e-9;
    }
    if (given.angles) {
        options.angles_in_degrees = *given.angles == "deg";
    }
    for (const std::string& column : given.columns) {
        const std::size_t equals = column.find('=');
        if (equals == std::string::npos || equals == 0) {
            throw UsageError("--column is '{}': expected SIGNAL=NAME, such as x=pos_east", column);
        }
        options.columns.emplace_back(column.substr(0, equals), column.substr(equals + 1));
    }
    options.allows_truncation = given.allows_truncation;
    options.topics = given.topics;
    return options;
}

/// A plan that can be flown, and what its file says besides.
struct ReadPlan {
    std::unique_ptr<const ComparedPlan> plan;
    std::string problem;
    std::uint64_t seed = 1;
};

std::string problem_file(const CompareLogArguments& given) {
    if (given.problem) {
        return *given.problem;
    }
    const std::filesystem::path beside = std::filesystem::path(plan_file(given.plan)).parent_path() / "effective.yaml";
    if (!std::filesystem::exists(beside)) {
        throw UsageError("{} is not there: --problem-file says which problem the plan is of", beside.string());
    }
    return beside.string();
}

template <class AnySolution, class SomeProblem>
ReadPlan planned(const SomeProblem& problem, const AnySolution& solution) {
    return {compared_plan(in_order(problem, solution.order), *solution.plan), problem.name, solution.seed};
}

ReadPlan read_plan(const CompareLogArguments& given) {
    const AnyProblem problem = read_any_problem(problem_file(given));
    const std::string plan = plan_file(given.plan);
    require_whole_plan(given.plan);
    return std::visit([&plan](const auto& of) { return planned(of, read_solution(plan, of)); }, problem);
}

/// A world of the plan's certificate, which others of it follow; the first one of all without a certificate.
std::uint64_t first_world(const std::string& solution_text) {
    const Json solution = Json::parse(solution_text);
    const auto certificate = solution.find("certificate");
    if (certificate == solution.end() || !certificate->is_object() || !certificate->contains("worst")) {
        return 1;
    }
    std::optional<std::uint64_t> least;
    for (const Json& sample : certificate->at("worst")) {
        const auto world = sample.value("world", std::uint64_t{1});
        least = std::min(least.value_or(world), world);
    }
    return least.value_or(1);
}

/// A list of numbers of every so many rows; what is not finite becomes null.
template <class Number>
Json listed(const std::vector<ComparedRow>& rows, std::size_t step, const Number& number) {
    auto list = Json::array();
    for (std::size_t i = 0; i < rows.size(); i += step) {
        const double value = number(rows[i]);
        list.push_back(std::isfinite(value) ? Json(value) : Json());
    }
    return list;
}

std::string page_data_of(const ShownComparison& shown, const Json& findings, const std::string& command) {
    constexpr std::size_t most_points = 1500;
    const LogComparison& comparison = shown.comparison;
    const std::vector<ComparedRow>& rows = comparison.rows;
    const std::size_t step = rows.size() / most_points + 1;
    const auto places = [&](Vector3 ComparedRow::*what) {
        auto axes = Json::array();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            axes.push_back(listed(rows, step, [&](const ComparedRow& row) { return (row.*what)[axis]; }));
        }
        return axes;
    };
    const auto numbers = [&](double ComparedRow::*what) {
        return listed(rows, step, [&](const ComparedRow& row) { return row.*what; });
    };
    Json series{{"t_s", numbers(&ComparedRow::t_s)},
                {"reference_m", places(&ComparedRow::reference_m)},
                {"planned_m", places(&ComparedRow::planned_m)},
                {"flown_m", places(&ComparedRow::flown_m)},
                {"clearance_m", numbers(&ComparedRow::clearance_m)},
                {"planned_clearance_m", numbers(&ComparedRow::planned_clearance_m)}};
    if (comparison.thrust) {
        series["thrust_n"] = numbers(&ComparedRow::thrust_n);
        series["planned_thrust_n"] = numbers(&ComparedRow::planned_thrust_n);
        series["free_air_thrust_n"] = numbers(&ComparedRow::free_air_thrust_n);
    }
    if (comparison.envelope) {
        const WorldEnvelope& envelope = comparison.envelope->envelope;
        const auto edge = [&](const std::vector<Vector3>& places_m) {
            auto axes = Json::array();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                axes.push_back(listed(rows, step, [&](const ComparedRow& row) {
                    const auto tick = static_cast<std::size_t>(std::llround(row.t_s / envelope.tick_s));
                    return tick < places_m.size() ? places_m[tick][axis] : NAN;
                }));
            }
            return axes;
        };
        series["low_m"] = edge(envelope.low_m);
        series["high_m"] = edge(envelope.high_m);
    }
    const Json page{{"schema", "downwash/comparison-report/v1"},
                    {"version", version()},
                    {"command", command},
                    {"problem", shown.problem},
                    {"findings", findings},
                    {"series", std::move(series)}};
    return page.dump(-1, ' ', true, Json::error_handler_t::replace);
}

std::string command_of(const CompareLogArguments& given) {
    std::string command = "downwash compare " + shell_word(given.plan);
    for (const std::string& log : given.logs) {
        command += " " + shell_word(log);
    }
    const auto add = [&command](const char* name, const std::optional<std::string>& value) {
        command += value ? fmt::format(" {} {}", name, shell_word(*value)) : std::string();
    };
    add("--problem-file", given.problem);
    add("--log-format", given.format);
    add("--axes", given.axes);
    add("--time-unit", given.time_unit);
    add("--angles", given.angles);
    for (const std::string& column : given.columns) {
        command += " --column " + shell_word(column);
    }
    for (const std::string& topic : given.topics) {
        command += " --topic " + shell_word(topic);
    }
    command += given.time_offset_s ? fmt::format(" --time-offset {}", *given.time_offset_s) : std::string();
    command += given.worlds ? fmt::format(" --envelope-worlds {}", *given.worlds) : std::string();
    command += given.is_in_world ? " --in-world" : "";
    return command + (given.allows_truncation ? " --allow-truncated" : "");
}

void write_comparison(const CompareLogArguments& given, const OutputFolder& folder, const ShownComparison& shown,
                      const Json& findings) {
    NamedTexts files{{findings_name, text_of(findings)}};
    if (has_pages()) {
        files.emplace_back(page_name, comparison_page(page_data_of(shown, findings, command_of(given))));
    }
    write_together(folder.path(), files);
}

}  // namespace

ExitCode compare_with_log(const CompareLogArguments& given) {
    Interruption interruption;
    ProgressDisplay display(given.is_quiet);
    const LogOptions options = log_options(given);
    const ReadPlan read = read_plan(given);
    const std::string solution_text =
        naming(plan_file(given.plan), [&] { return read_whole_file(plan_file(given.plan), max_solution_bytes); });
    ComparisonOptions how;
    how.alignment = {given.time_offset_s, given.is_in_world};
    if (given.worlds && (*given.worlds > most_worlds || (*given.worlds > 0 && !read.plan->has_uncertainty()))) {
        throw UsageError(*given.worlds > most_worlds
                             ? fmt::format("--envelope-worlds is {}: expected at most {}", *given.worlds, most_worlds)
                             : "--envelope-worlds needs to know what is uncertain: the problem has no `uncertainty:`");
    }
    how.worlds = {read.seed, first_world(solution_text),
                  given.worlds.value_or(read.plan->has_uncertainty() ? usual_worlds : 0), given.threads,
                  interruption.token()};
    const std::optional<OutputFolder> folder = given.out ? std::optional<OutputFolder>(*given.out) : std::nullopt;

    FlightLog log = read_flight_log({given.logs.begin(), given.logs.end()}, options);
    ShownComparison shown{read.problem, given.plan, {}, read.plan->safety_margin_m(), {}};
    shown.log.files = log.files;
    shown.log.recorded_axes = log.recorded_axes;
    shown.log.axes_source = log.axes_source;
    shown.log.rotor_unit = log.rotor_unit;
    shown.log.remarks = log.remarks;
    const Json of_log = json_of(log);
    if (how.worlds.count > 0) {
        display.say(
            fmt::format("{}: flying the plan in {} worlds of seed {}", read.problem, how.worlds.count, read.seed));
    }
    shown.comparison = compare(std::move(log), *read.plan, how);
    if (shown.comparison.alignment.is_turned_over) {
        shown.log.recorded_axes = shown.log.recorded_axes == LogAxes::down ? LogAxes::up : LogAxes::down;
    }
    const Json findings = json_of(shown, of_log);
    if (folder) {
        write_comparison(given, *folder, shown, findings);
    }
    if (given.as_json) {
        print_json(findings);
    } else {
        fmt::print("{}", text_of(shown, of_log));
    }
    return interruption.code();
}

}  // namespace downwash::cli
