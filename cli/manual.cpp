#include "downwash/cli/manual.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
#include "downwash/cli/command_table.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/output_folder.hpp"
#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {
namespace {

std::string with_dashes(std::string name) {
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

/// Text as roff shows it: no letter of it is a command.
std::string in_roff(const std::string& text) {
    std::string roff;
    for (const char letter : text) {
        if (letter == '\\') {
            roff += "\\e";
        } else if (letter == '-') {
            roff += "\\-";
        } else if ((letter == '.' || letter == '\'') && (roff.empty() || roff.back() == '\n')) {
            roff += std::string("\\&") + letter;
        } else {
            roff += letter;
        }
    }
    return roff;
}

/// "--seed N" or "PROBLEM"
std::string spelled(const CLI::Option& option) {
    std::string text = option.get_positional() ? option.get_name(true) : option.get_name(false, true);
    if (!option.get_positional() && option.get_items_expected_max() > 0) {
        text += " " + option.get_type_name();
    }
    return text;
}

std::string options_section(const CLI::App& command) {
    std::string text;
    for (const bool is_positional : {true, false}) {
        for (const CLI::Option* option : options_of(command, is_positional)) {
            text += fmt::format(".TP\n.B {}\n{}\n", in_roff(spelled(*option)), in_roff(option->get_description()));
        }
    }
    return text.empty() ? "" : ".SH OPTIONS\n" + text;
}

std::string commands_section(const CLI::App& command) {
    std::string text;
    for (const CLI::App* below : commands_of(command)) {
        text += fmt::format(".TP\n.B {}\n{}\n", in_roff(full_name(*below)), in_roff(below->get_description()));
    }
    return text.empty() ? "" : ".SH COMMANDS\n" + text;
}

std::string synopsis(const CLI::App& command) {
    std::string text = ".B " + in_roff(full_name(command)) + "\n";
    if (!commands_of(command).empty()) {
        return text + "COMMAND\n";
    }
    for (const CLI::Option* option : options_of(command, true)) {
        text += in_roff(option->get_name(true)) + (option->get_items_expected_max() > 1 ? "...\n" : "\n");
    }
    return text + "[OPTIONS]\n";
}

/// Text as the cell of a Markdown table.
std::string in_cell(const std::string& text) {
    std::string cell;
    for (const char letter : text) {
        cell += letter == '|' ? "\\|" : letter == '\n' ? " " : std::string(1, letter);
    }
    return cell;
}

/// How a command is written: "downwash solve [OPTIONS] PROBLEM"
std::string usage_line(const CLI::App& command) {
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

std::string markdown_options(const CLI::App& command) {
    std::string rows;
    for (const bool is_positional : {true, false}) {
        for (const CLI::Option* option : options_of(command, is_positional)) {
            if (option == command.get_help_ptr()) {
                continue;
            }
            std::string name = spelled(*option);
            name.erase(std::min(name.find(':'), name.size()));  // what follows is a check, and stands in the text
            const std::string standard = option->get_default_str();
            rows += fmt::format("| `{}` | {}{}{} |\n", in_cell(name), in_cell(option->get_description()),
                                standard.empty() ? "" : "; default " + in_cell(standard),
                                option->get_required() && !is_positional ? " (required)" : "");
        }
    }
    return rows.empty() ? "" : "\n| | |\n| --- | --- |\n" + rows;
}

struct ManualArguments {
    std::vector<std::string> command;
    std::optional<std::string> all;
    bool is_markdown = false;
    std::string shell;
};

ExitCode print_man_page(const CLI::App& program, const std::vector<std::string>& names) {
    const CLI::App* command = &program;
    for (const std::string& name : names) {
        const auto below = commands_of(*command);
        const auto found =
            std::find_if(below.begin(), below.end(), [&name](const CLI::App* one) { return one->get_name() == name; });
        if (found == below.end()) {
            throw UsageError(fmt::format("there is no command '{} {}'", full_name(*command), excerpt(name)));
        }
        command = *found;
    }
    fmt::print("{}", man_page(*command));
    return ExitCode::done;
}

ExitCode write_man_pages(const CLI::App& program, const std::string& folder) {
    const OutputFolder pages(folder);
    for_each_command(program, [&pages](const CLI::App& command) {
        pages.write(with_dashes(full_name(command)) + ".1", man_page(command));
    });
    return ExitCode::done;
}

}  // namespace

void add_manual(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<ManualArguments>();
    CLI::App* manual = program.add_subcommand(
        "manual", "Print a manual page: downwash manual solve | man -l -; without a command that of the program");
    CLI::Option* command = manual->add_option("COMMAND", arguments->command, "whose page, for example: aeromap plot");
    CLI::Option* all = manual
                           ->add_option("--all", arguments->all,
                                        "write the pages of all commands to a folder instead: downwash-solve.1...")
                           ->type_name("DIR")
                           ->excludes(command);
    manual->add_flag("--markdown", arguments->is_markdown, "all commands as one Markdown page instead")
        ->excludes(command)
        ->excludes(all);
    manual->callback([arguments, &program, &action] {
        action = [arguments, &program] {
            if (arguments->is_markdown) {
                fmt::print("{}", markdown_page(program));
                return ExitCode::done;
            }
            return arguments->all ? write_man_pages(program, *arguments->all)
                                  : print_man_page(program, arguments->command);
        };
    });
    CLI::App* completion = program.add_subcommand(
        "completion", "Print what completes command lines in a shell: source <(downwash completion bash)");
    CLI::Option* shell = completion->add_option("SHELL", arguments->shell, "bash or zsh")->required();
    require_one_of(*shell, std::array<std::string_view, 2>{"bash", "zsh"});
    completion->callback([arguments, &program, &action] {
        action = [arguments, &program] {
            fmt::print("{}", completion_script(program, arguments->shell));
            return ExitCode::done;
        };
    });
}

std::string man_page(const CLI::App& command) {
    const std::string name = full_name(command);
    std::string title = with_dashes(name);
    std::transform(title.begin(), title.end(), title.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    std::string page = fmt::format(".TH {} 1 \"\" \"Downwash {}\" \"Downwash\"\n", title, version());
    page += fmt::format(".SH NAME\n{} \\- {}\n", in_roff(with_dashes(name)), in_roff(command.get_description()));
    page += ".SH SYNOPSIS\n" + synopsis(command) + options_section(command) + commands_section(command);
    if (!command.get_footer().empty()) {
        page += ".SH EXIT STATUS\n" + in_roff(command.get_footer()) + "\n";
    }
    return page;
}

std::string markdown_page(const CLI::App& program) {
    std::string contents;
    std::string sections;
    for_each_command(program, [&](const CLI::App& command) {
        if (command.get_parent() == nullptr) {
            return;
        }
        const std::string name = full_name(command);
        contents += fmt::format("| [`{}`](#{}) | {} |\n", name, with_dashes(name), in_cell(command.get_description()));
        sections += fmt::format("\n## {}\n\n{}.\n\n```\n{}\n```\n{}", name, command.get_description(),
                                usage_line(command), markdown_options(command));
    });
    return fmt::format(
        "# Commands\n\n"
        "Printed from the table that reads the command line (`cmake --build build --target docs`). `{0} COMMAND "
        "--help` says the same\nof one command, `{0} manual COMMAND | man -l -` shows it as a manual page, `{0} "
        "completion bash` completes it.\n\n"
        "| command | |\n| --- | --- |\n{1}\n{2}\n{3}",
        program.get_name(), contents, program.get_footer(), sections);
}

}  // namespace downwash::cli
