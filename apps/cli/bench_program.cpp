// The program downwash-bench.

#include "downwash/cli/bench_commands.hpp"
#include "downwash/cli/program.hpp"

int main(int argc, char** argv) {
    using namespace downwash::cli;
    return run_part("bench", argc, argv, [](Command program, Action& action) {
        add_bench(program, action,
                  {run_campaign, write_slurm_scripts, write_parallel_scripts, merge_shards, report_campaign});
    });
}
