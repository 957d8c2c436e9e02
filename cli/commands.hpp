#pragma once

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

// Each adds its command to the program, to `aeromap`, `bench` or `study`; a command that is given stores what it does
// in `action`.
void add_check(Command program, Action& action);
void add_solve(Command program, Action& action);
void add_execute(Command program, Action& action);
void add_validate(Command program, Action& action);
void add_export(Command program, Action& action);
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
void add_aeromap_fit(Command aeromap, Action& action);
void add_aeromap_compare(Command aeromap, Action& action);
void add_aeromap_hold(Command aeromap, Action& action);
void add_aeromap_plot(Command aeromap, Action& action);
void add_bench_run(Command bench, Action& action);
void add_bench_merge(Command bench, Action& action);
void add_bench_parallel(Command bench, Action& action);
void add_bench_report(Command bench, Action& action);
void add_bench_slurm(Command bench, Action& action);
void add_study_uncertainty(Command study, Action& action);
void add_thesis_studies(Command study, Action& action);

}  // namespace downwash::cli
