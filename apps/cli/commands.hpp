#pragma once

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

// Each adds its command to the program or to `aeromap`; a command that is given stores what it does in `action`.
void add_check(Command program, Action& action);
void add_solve(Command program, Action& action);
void add_execute(Command program, Action& action);
void add_replan(Command program, Action& action);
void add_init(Command program, Action& action);
void add_explain(Command program, Action& action);
void add_manual(Command program, Action& action);
void add_completion(Command program, Action& action);
void add_report(Command program, Action& action);
void add_margins(Command program, Action& action);
void add_planners(Command program, Action& action);
void add_aeromap_query(Command aeromap, Action& action);
void add_aeromap_build(Command aeromap, Action& action);
void add_aeromap_info(Command aeromap, Action& action);
void add_aeromap_hold(Command aeromap, Action& action);
void add_aeromap_plot(Command aeromap, Action& action);

}  // namespace downwash::cli
