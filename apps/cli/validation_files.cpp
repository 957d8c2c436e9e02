#include "downwash/cli/validation_files.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "downwash/cli/output.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/space_problem_writer.hpp"
#include "downwash/report/run_page.hpp"
#include "downwash/report/space_page.hpp"
#include "downwash/report/validation_page.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash::cli {
namespace {

constexpr char findings_name[] = "validation.json";
constexpr char page_name[] = "validation.html";
constexpr std::size_t most_played = 5;  ///< of the worst flights

/// The judge's rows with the place of the end effector, up to where the vehicle was lost.
NumberTable table_of(const judge::JudgedFlight& flight, const ArmParameters& arm) {
    NumberTable table;
    table.names = {"t_s",     "ref_x_m", "ref_z_m", "ref_arm_rad", "x_m",    "z_m",    "pitch_rad",
                   "arm_rad", "vx_m_s",  "vz_m_s",  "clearance_m", "ee_x_m", "ee_z_m", "energy_j"};
    table.columns.resize(table.names.size());
    for (const judge::JudgedRow& row : flight.rows) {
        const double x_m = row.pose.x_m, z_m = row.pose.z_m;
        const double pitch_rad = row.pose.pitch_rad, arm_rad = row.pose.arm_rad;
        const double cos = std::cos(pitch_rad), sin = std::sin(pitch_rad);
        const double ee_x_m =
            x_m + arm.joint_x_m * cos + arm.joint_z_m * sin + arm.length_m * std::cos(pitch_rad + arm_rad);
        const double ee_z_m =
            z_m - arm.joint_x_m * sin + arm.joint_z_m * cos - arm.length_m * std::sin(pitch_rad + arm_rad);
        if (!std::isfinite(ee_x_m) || !std::isfinite(ee_z_m)) {
            break;
        }
        const double clearance_m =
            std::isfinite(row.clearance_m) ? row.clearance_m : std::numeric_limits<double>::quiet_NaN();
        table.add_row({row.t_s, row.reference_x_m, row.reference_z_m, row.reference_arm_rad, x_m, z_m, pitch_rad,
                       arm_rad, row.vx_m_s, row.vz_m_s, clearance_m, ee_x_m, ee_z_m, row.energy_j});
    }
    return table;
}

PlayableFlight playable(const judge::JudgedFlight& flight, const Problem& problem, const ValidationSource& source,
                        std::optional<std::uint64_t> index) {
    PlayableFlight shown;
    shown.world = index;
    shown.outcome = name_of(flight.outcome);
    shown.rows = table_of(flight, problem.robot.arm);
    if (index) {
        const World world = draw_world(*problem.uncertainty, problem.robot, source.seed, *index);
        shown.scene_x_m = world.scene_x_m;
        shown.scene_z_m = world.scene_z_m;
        shown.lateral_m = make_world(problem.robot, world).lateral_m;
    }
    return shown;
}

std::string command_of(const Validation& validation, const ValidationSource& source) {
    std::string command =
        fmt::format("downwash validate {} --plan {}", shell_word(source.problem_file), shell_word(source.plan));
    if (validation.worlds) {
        command += fmt::format(" --runs {} --seed {}", validation.worlds->runs.size(), source.seed);
    } else if (validation.world) {
        command += fmt::format(" --world {} --seed {}", *validation.world, source.seed);
    }
    return command;
}

ValidationRecord record_of(const Validation& validation, const std::string& findings, const judge::PlanJudge& judge,
                           const Plan& plan, const ValidationSource& source) {
    const Problem& problem = judge.problem();
    ValidationRecord record;
    record.findings = findings;
    record.is_valid = validation.is_valid();
    record.has_flight_claims = validation.has_flight_claims;
    record.solution_text = source.solution.text;
    record.seed = source.seed;
    record.command = command_of(validation, source);
    record.flights.push_back(playable(validation.flight, problem, source, validation.world));
    if (validation.worlds) {
        const judge::WorldRuns& worlds = *validation.worlds;
        if (worlds.fan) {
            record.clearance = {worlds.fan->step_s, worlds.fan->minimum, worlds.fan->p01, worlds.fan->p10,
                                worlds.fan->p50};
        }
        for (std::size_t i = 0; i < std::min(most_played, worlds.worst.size()); ++i) {
            const std::uint64_t index = worlds.worst[i].world;
            const World world = draw_world(*problem.uncertainty, problem.robot, source.seed, index);
            record.flights.push_back(playable(judge.fly(plan, {true, world}), problem, source, index));
        }
    }
    return record;
}

/// The run that a plan in space is of, to be shown beside the findings: without a flight unless its folder holds one of
/// the same problem.
SpaceRun run_beside(const SpaceProblem& problem, const SourceFile& solution) {
    const std::filesystem::path folder = solution.path.parent_path();
    try {
        if (is_space_run(folder)) {
            const SpaceRunRecord record = read_space_run(folder);
            if (problem_sha256(record.problem) == problem_sha256(problem)) {
                return shown_run(record);
            }
        }
    } catch (const ProblemFileError&) {  // the plan alone is whole
    } catch (const InputError&) {
    }
    return {};
}

/// Writes validation.json; a page of before goes. @return its text
std::string write_findings(const OutputFolder& folder, const Validation& validation, const SourceFile& solution) {
    std::string findings = cli::text_of(json_of(validation));
    // The page takes a while and is written when the findings are safe; that of before goes first.
    std::error_code ignored;
    std::filesystem::remove(folder.path() / page_name, ignored);
    write_made_from(solution, folder.path(), {{findings_name, findings}});
    return findings;
}

}  // namespace

void write_validation(const OutputFolder& folder, const Validation& validation, const judge::PlanJudge& judge,
                      const Plan& plan, const ValidationSource& source) {
    const std::string findings = write_findings(folder, validation, source.solution);
    if (!has_pages()) {
        return;
    }
    const Problem& problem = judge.problem();
    const auto model = make_flight_model(problem);
    const ValidationRecord record = record_of(validation, findings, judge, plan, source);
    write_made_from({folder.path() / findings_name, findings}, folder.path(),
                    {{page_name, validation_page(record, problem, *model, source.threads)}});
}

void write_validation(const OutputFolder& folder, const Validation& validation, const SpaceProblem& problem,
                      const SourceFile& solution) {
    const std::string findings = write_findings(folder, validation, solution);
    if (!has_pages()) {
        return;
    }
    SpaceRun run = run_beside(problem, solution);
    run.findings = findings;
    write_made_from({folder.path() / findings_name, findings}, folder.path(), {{page_name, space_page(problem, run)}});
}

}  // namespace downwash::cli
