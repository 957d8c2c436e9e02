#include "downwash/cli/validate_command.hpp"

#include "downwash/cli/common_options.hpp"

namespace downwash::cli {

void add_validate(Command program, Action& action, ExitCode (*run)(const ValidateArguments&)) {
    auto [command, given] =
        add_command(program, action, "validate",
                    "Fly a plan with an independent simulator and compare the flight with what the plan's file says; "
                    "with --runs, fly it in many worlds of the problem's uncertainty and estimate how often it fails",
                    run);
    given.threads = default_threads();
    add_problem(command, given.problem);
    add_plan(command, given.plan);
    command.add_option("--runs N", given.runs, "fly in the worlds 1 to N of the problem's uncertainty as well");
    command.add_option("--world I", given.world,
                       "world I of the problem's uncertainty to fly in; default: the nominal one");
    command.add_option("--seed N", given.seed, "seed of the random numbers; of the worlds, default: that of the plan");
    add_out(command, "DIR", given.out,
            "folder for validation.json, what --json prints, and the page validation.html; default: no files");
    add_threads(command, given.threads);
    add_quiet(command, given.is_quiet);
    add_json(command, given.as_json);
}

}  // namespace downwash::cli
