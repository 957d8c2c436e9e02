// The program downwash: every command, some of them as options that the program of an optional component acts on.

#include "downwash/cli/bench_commands.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/compare_command.hpp"
#include "downwash/cli/export_command.hpp"
#include "downwash/cli/fit_commands.hpp"
#include "downwash/cli/identify_command.hpp"
#include "downwash/cli/program.hpp"
#include "downwash/cli/robot_commands.hpp"
#include "downwash/cli/study_commands.hpp"
#include "downwash/cli/validate_command.hpp"

namespace downwash::cli {
namespace {

void add_aeromap(Command program, Action& action) {
    Command aeromap = add_aeromap_group(program);
    add_aeromap_query(aeromap, action);
    add_aeromap_build(aeromap, action);
    add_aeromap_info(aeromap, action);
    add_aeromap_plot(aeromap, action);
    add_aeromap_fit(aeromap, action, nullptr);
    add_aeromap_compare(aeromap, action, nullptr);
    add_aeromap_hold(aeromap, action);
}

void add_robot(Command program, Action& action) {
    Command robot = add_robot_group(program);
    add_robot_import(robot, action, nullptr);
    add_robot_show(robot, action, show_robot_file);
    add_robot_thrust(robot, action);
}

/// All commands, in the order of the help.
void add_all(Command program, Action& action) {
    add_init(program, action);
    add_check(program, action);
    add_explain(program, action);
    add_solve(program, action);
    add_replan(program, action);
    add_execute(program, action);
    add_validate(program, action, nullptr);
    add_compare(program, action, nullptr);
    add_aeromap(program, action);
    add_bench(program, action, {});
    add_study(program, action, {});
    add_report(program, action);
    add_export(program, action, nullptr);
    add_robot(program, action);
    add_identify(program, action, nullptr);
    add_margins(program, action);
    add_planners(program, action);
    add_manual(program, action);
    add_completion(program, action);
}

}  // namespace
}  // namespace downwash::cli

int main(int argc, char** argv) {
    return downwash::cli::run_program({argv, static_cast<std::size_t>(argc)}, downwash::cli::add_all);
}
