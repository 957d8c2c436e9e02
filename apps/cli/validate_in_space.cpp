#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "downwash/base/files.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/cli/validate_command.hpp"
#include "downwash/cli/validation.hpp"
#include "downwash/cli/validation_files.hpp"
#include "downwash/judge/space_disagreements.hpp"
#include "downwash/judge/space_plan_judge.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/claims.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

namespace downwash::cli {
namespace {

/// The world of an index; nothing for the nominal flight.
std::optional<SpaceWorld> world_of(const SpaceProblem& problem, std::uint64_t seed,
                                   const std::optional<std::uint64_t>& index) {
    return index ? std::optional(draw_space_world(*problem.uncertainty, problem.robot, seed, *index)) : std::nullopt;
}

/// Compares what the file says about its flight with the same flight of the judge.
/// @param nominal the nominal flight with surface effects, if it was flown already
std::vector<judge::Disagreement> compare_flight(const judge::SpacePlanJudge& judge, const SpaceClaims& claims,
                                                const judge::SpaceJudgedFlight* nominal) {
    const FlightClaims& said = *claims.flight;
    const SpaceProblem& problem = judge.problem();
    if (nominal != nullptr && !said.world && said.aero) {
        return judge::disagreements_about_flight(claims, *nominal);
    }
    std::optional<SpaceWorld> world;
    if (said.world) {
        if (!problem.uncertainty) {
            throw UsageError(
                "the plan's `execution` was flown in world {} of an uncertainty, but the problem has no "
                "`uncertainty:`; is it the plan of another problem?",
                said.world->index);
        }
        world = world_of(problem, said.world->seed, said.world->index);
    }
    return judge::disagreements_about_flight(claims, judge.fly(claims.plan, said.aero, world));
}

/// The figures that are shown of a flight.
judge::JudgedFlight figures_of(const judge::SpaceJudgedFlight& flight) {
    judge::JudgedFlight figures;
    figures.outcome = flight.outcome;
    figures.min_clearance_m = flight.min_clearance_m;
    figures.energy_j = flight.energy_j;
    figures.duration_s = flight.duration_s;
    figures.max_tracking_error_m = flight.max_tracking_error_m;
    figures.goal_error_m = judge::worst_goal_error_m(flight);
    return figures;
}

}  // namespace

ExitCode validate_in_space(const ValidateArguments& given) {
    Interruption interruption;
    const auto on_warning = [&given](const LocatedError& warning) {
        if (!given.is_quiet) {
            print_warning(warning);
        }
    };
    const SpaceProblem problem = read_space_problem(given.problem, {}, on_warning);
    check_options(given, problem.uncertainty.has_value());
    const std::string plan = plan_file(given.plan);
    const SpaceClaims claims = read_claims(plan, problem);
    require_whole_plan(given.plan);
    const SourceFile source{plan, read_whole_file(plan, max_solution_bytes)};
    const std::uint64_t seed = given.seed.value_or(claims.seed);
    const std::optional<OutputFolder> folder = given.out ? std::optional<OutputFolder>(*given.out) : std::nullopt;

    const SpaceProblem flown = in_order(problem, claims.order);
    const judge::SpacePlanJudge judge(flown);
    Validation validation;
    validation.world = given.world;
    const judge::SpaceJudgedFlight flight = judge.fly(claims.plan, true, world_of(problem, seed, given.world));
    validation.flight = figures_of(flight);
    validation.is_self_collision = flight.is_self_collision;
    validation.disagreements = judge::disagreements_in_plan(claims, flown);
    std::ranges::move(disagreements_about_order(claims.order, problem), std::back_inserter(validation.disagreements));
    if (claims.flight) {
        validation.has_flight_claims = true;
        auto more = compare_flight(judge, claims, given.world ? nullptr : &flight);
        std::move(more.begin(), more.end(), std::back_inserter(validation.disagreements));
    }
    if (given.runs) {
        ProgressDisplay display(given.is_quiet);
        display.say(fmt::format("{}: flying the plan in {} worlds of seed {}", problem.name, *given.runs, seed));
        validation.worlds = judge::fly_in_worlds(judge, claims.plan,
                                                 {*given.runs, seed, given.threads, 0, interruption.token(),
                                                  [&](double share) { display.show("worlds", share); }});
        if (!validation.worlds) {
            display.say("interrupted before all worlds were flown: there are no statistics");
        }
    }
    if (folder) {
        write_validation(*folder, validation, problem, source);
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
