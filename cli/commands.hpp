#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "downwash/cli/exit_code.hpp"

namespace downwash::cli {

/// What a parsed command line asks for.
using Action = std::function<ExitCode()>;

// Each adds its command to the program, to `aeromap`, `bench` or `study`; a command that is given stores what it does
// in `action`.
void add_check(CLI::App& program, Action& action);
void add_solve(CLI::App& program, Action& action);
void add_execute(CLI::App& program, Action& action);
void add_validate(CLI::App& program, Action& action);
void add_export(CLI::App& program, Action& action);
void add_init(CLI::App& program, Action& action);
void add_explain(CLI::App& program, Action& action);
void add_manual(CLI::App& program, Action& action);
void add_completion(CLI::App& program, Action& action);
void add_report(CLI::App& program, Action& action);
void add_margins(CLI::App& program, Action& action);
void add_planners(CLI::App& program, Action& action);
void add_aeromap_query(CLI::App& aeromap, Action& action);
void add_aeromap_build(CLI::App& aeromap, Action& action);
void add_aeromap_info(CLI::App& aeromap, Action& action);
void add_aeromap_fit(CLI::App& aeromap, Action& action);
void add_aeromap_compare(CLI::App& aeromap, Action& action);
void add_aeromap_hold(CLI::App& aeromap, Action& action);
void add_aeromap_plot(CLI::App& aeromap, Action& action);
void add_bench_run(CLI::App& bench, Action& action);
void add_bench_merge(CLI::App& bench, Action& action);
void add_bench_parallel(CLI::App& bench, Action& action);
void add_bench_report(CLI::App& bench, Action& action);
void add_bench_slurm(CLI::App& bench, Action& action);
void add_study_uncertainty(CLI::App& study, Action& action);
void add_thesis_studies(CLI::App& study, Action& action);

}  // namespace downwash::cli
