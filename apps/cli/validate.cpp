#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>

#include "downwash/base/files.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/plan_origin.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/cli/validate_command.hpp"
#include "downwash/cli/validation.hpp"
#include "downwash/cli/validation_files.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/claims.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash::cli {
namespace {

constexpr std::uint64_t most_runs = 10'000'000;

World world_of(const Problem& problem, std::uint64_t seed, std::uint64_t index) {
    return draw_world(*problem.uncertainty, problem.robot, seed, index);
}

/// Compares what the file says about its flight with the same flight of the judge.
/// @param nominal the nominal flight with surface effects, if it was flown already
std::vector<judge::Disagreement> compare_flight(const judge::PlanJudge& judge, const Claims& claims,
                                                const judge::JudgedFlight* nominal) {
    const FlightClaims& said = *claims.flight;
    const double tick_s = claims.plan.tick_s;
    if (nominal != nullptr && !said.world && said.aero == judge.problem().aero.enabled) {
        return judge::disagreements_about_flight(said, claims.objective, *nominal, tick_s);
    }
    judge::FlightConditions conditions{said.aero, std::nullopt};
    if (said.world) {
        if (!judge.problem().uncertainty) {
            throw UsageError(
                "the plan's `execution` was flown in world {} of an uncertainty, but the problem has no "
                "`uncertainty:`; is it the plan of another problem?",
                said.world->index);
        }
        conditions.world = world_of(judge.problem(), said.world->seed, said.world->index);
    }
    return judge::disagreements_about_flight(said, claims.objective, judge.fly(claims.plan, conditions), tick_s);
}

}  // namespace

void check_options(const ValidateArguments& given, bool has_uncertainty) {
    if (given.runs && given.world) {
        throw UsageError("--runs flies many worlds and --world one: expected one of them");
    }
    if (given.seed && !given.runs && !given.world) {
        throw UsageError("--seed says which worlds there are: expected --runs or --world too");
    }
    if (given.runs && (*given.runs < 1 || *given.runs > most_runs)) {
        throw UsageError("--runs is {}: expected 1 to {}", *given.runs, most_runs);
    }
    if ((given.runs || given.world) && !has_uncertainty) {
        throw UsageError(
            "{} needs to know what is uncertain: {} has no `uncertainty:`, or `uncertainty: none`; `uncertainty: {{}}` "
            "stands for the defaults",
            given.runs ? "--runs" : "--world", given.problem);
    }
}

std::string command_for_one(const ValidateArguments& given) {
    return fmt::format("downwash validate {} --plan {}{} --world", shell_word(given.problem), shell_word(given.plan),
                       given.seed ? fmt::format(" --seed {}", *given.seed) : "");
}

ExitCode validate(const ValidateArguments& given) {
    if (is_space_problem_file(given.problem)) {
        return validate_in_space(given);
    }
    Interruption interruption;
    const Problem problem = read_problem(given.problem, {}, given.is_quiet ? nullptr : print_outdated);
    check_options(given, problem.uncertainty.has_value());
    const Claims claims = read_claims(plan_file(given.plan), problem);
    require_whole_plan(given.plan);
    const SourceFile source{plan_file(given.plan), read_whole_file(plan_file(given.plan), max_solution_bytes)};
    const std::uint64_t seed = given.seed.value_or(claims.seed);
    const std::optional<OutputFolder> folder = given.out ? std::optional<OutputFolder>(*given.out) : std::nullopt;

    const Problem flown = in_order(problem, claims.order);
    const judge::PlanJudge judge(flown);
    Validation validation;
    judge::FlightConditions conditions;
    if (given.world) {
        conditions.world = world_of(problem, seed, *given.world);
        validation.world = given.world;
    }
    validation.flight = judge.fly(claims.plan, conditions);
    validation.disagreements = judge::disagreements_in_plan(claims, flown);
    std::ranges::move(disagreements_about_order(claims.order, problem), std::back_inserter(validation.disagreements));
    if (claims.flight) {
        validation.has_flight_claims = true;
        auto more = compare_flight(judge, claims, given.world ? nullptr : &validation.flight);
        std::move(more.begin(), more.end(), std::back_inserter(validation.disagreements));
    }
    if (given.runs) {
        ProgressDisplay display(given.is_quiet);
        display.say(fmt::format("{}: flying the plan in {} worlds of seed {}", problem.name, *given.runs, seed));
        validation.worlds =
            judge::fly_in_worlds(judge, claims.plan,
                                 {*given.runs, seed, given.threads, folder ? shown_clearance_step_s : 0,
                                  interruption.token(), [&](double share) { display.show("worlds", share); }});
        if (!validation.worlds) {
            display.say("interrupted before all worlds were flown: there are no statistics");
        } else if (const auto& fails = validation.worlds->failure_probability;
                   claims.certified_share && fails.low > *claims.certified_share &&
                   !is_of_another_problem(plan_file(given.plan), true, problem)) {
            validation.disagreements.push_back(
                {"certificate: failure probability at most", *claims.certified_share, fails.estimate});
        }
    }
    if (folder) {
        write_validation(*folder, validation, judge, claims.plan,
                         {given.problem, given.plan, source, seed, given.threads});
    }
    if (given.as_json) {
        print_json(json_of(validation));
    } else {
        fmt::print("{}", text_of(validation, command_for_one(given)));
    }
    if (interruption.code() != ExitCode::done) {
        return interruption.code();
    }
    return validation.is_valid() ? ExitCode::done : ExitCode::flight_failed;
}

}  // namespace downwash::cli
