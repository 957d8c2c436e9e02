#pragma once

// The commands and options that CLI11 reads, for manual pages and completions.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace downwash::cli {

/// The commands directly below one, in their order.
[[nodiscard]] inline std::vector<const CLI::App*> commands_of(const CLI::App& command) {
    return command.get_subcommands([](const CLI::App* below) { return !below->get_name().empty(); });
}

[[nodiscard]] inline std::vector<const CLI::Option*> options_of(const CLI::App& command, bool is_positional) {
    return command.get_options([=](const CLI::Option* option) { return option->get_positional() == is_positional; });
}

/// "downwash aeromap plot"
[[nodiscard]] inline std::string full_name(const CLI::App& command) {
    const CLI::App* parent = command.get_parent();
    return parent == nullptr ? command.get_name() : full_name(*parent) + " " + command.get_name();
}

/// "downwash solve [OPTIONS] PROBLEM"
[[nodiscard]] inline std::string usage_line(const CLI::App& command) {
    if (!commands_of(command).empty()) {
        return full_name(command) + " COMMAND";
    }
    std::string line = full_name(command) + " [OPTIONS]";
    for (const CLI::Option* option : options_of(command, true)) {
        const std::string name = option->get_name(true) + (option->get_items_expected_max() > 1 ? "..." : "");
        line += option->get_required() ? " " + name : " [" + name + "]";
    }
    return line;
}

/// Calls visit(command) for a command and all below it.
template <class Visit>
void for_each_command(const CLI::App& command, const Visit& visit) {
    visit(command);
    for (const CLI::App* below : commands_of(command)) {
        for_each_command(*below, visit);
    }
}

}  // namespace downwash::cli
