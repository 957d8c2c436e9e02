#include "downwash/cli/commands.hpp"

namespace downwash::cli {

void add_bench(CLI::App& program, Action& action) {
    CLI::App* bench = program.add_subcommand("bench", "Campaigns: how often, how soon and how well plans are found");
    bench->require_subcommand(1);
    add_bench_run(*bench, action);
    add_bench_report(*bench, action);
}

}  // namespace downwash::cli
