#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "downwash/cli/commands.hpp"
#include "downwash/cli/json_text.hpp"
#include "downwash/planner/solve.hpp"

namespace downwash::cli {
namespace {

void print_json() {
    auto list = nlohmann::ordered_json::array();
    for (const AlgorithmInfo& algorithm : algorithms()) {
        list.push_back({{"name", algorithm.name},
                        {"kind", algorithm.kind},
                        {"description", algorithm.description},
                        {"parameters", nlohmann::ordered_json::array()}});
    }
    fmt::print("{}\n", json_text(nlohmann::ordered_json{{"planners", std::move(list)}}));
}

void print_table() {
    for (const AlgorithmInfo& algorithm : algorithms()) {
        fmt::print("{}\n  kind        {}\n  about       {}\n  parameters  none of its own\n", algorithm.name,
                   algorithm.kind, algorithm.description);
    }
}

}  // namespace

void add_planners(CLI::App& program, Action& action) {
    const auto as_json = std::make_shared<bool>(false);
    CLI::App* command = program.add_subcommand("planners", "List the search algorithms");
    command->add_flag("--json", *as_json, "print them as JSON");
    command->callback([as_json, &action] {
        action = [as_json] {
            *as_json ? print_json() : print_table();
            return ExitCode::done;
        };
    });
}

}  // namespace downwash::cli
