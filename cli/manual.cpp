#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
#include "downwash/cli/command_walk.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {
namespace {

std::string with_dashes(std::string name) {
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

/// Text as roff shows it, with every character that roff would interpret escaped.
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

/// Positional arguments, then options.
std::vector<const CLI::Option*> all_options_of(const CLI::App& command) {
    std::vector<const CLI::Option*> all = options_of(command, true);
    const std::vector<const CLI::Option*> named = options_of(command, false);
    all.insert(all.end(), named.begin(), named.end());
    return all;
}

/// An entry of a list in a manual page.
std::string entry(const std::string& name, const std::string& description) {
    return fmt::format(".TP\n.B {}\n{}\n", in_roff(name), in_roff(description));
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
        cell += letter == '|' ? "\\|" : letter == '\n' ? "<br>" : std::string(1, letter);
    }
    return cell;
}

std::string markdown_options(const CLI::App& command) {
    std::string rows;
    for (const CLI::Option* option : all_options_of(command)) {
        if (option == command.get_help_ptr()) {
            continue;
        }
        std::string name = spelled(*option);
        name.erase(std::min(name.find(':'), name.size()));  // a check follows, which the description says too
        const std::string standard = option->get_default_str();
        rows += fmt::format("| `{}` | {}{}{} |\n", in_cell(name), in_cell(option->get_description()),
                            standard.empty() ? "" : "; default " + in_cell(standard),
                            option->get_required() && !option->get_positional() ? " (required)" : "");
    }
    return rows.empty() ? "" : "\n| | |\n| --- | --- |\n" + rows;
}

/// The page of a command for man(1), or of the whole program.
std::string man_page(const CLI::App& command) {
    const std::string name = with_dashes(full_name(command));
    std::string title = name;
    std::transform(title.begin(), title.end(), title.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    std::string page = fmt::format(".TH {} 1 \"\" \"Downwash {}\" \"Downwash\"\n", title, version());
    page += fmt::format(".SH NAME\n{} \\- {}\n", in_roff(name), in_roff(command.get_description()));
    page += ".SH SYNOPSIS\n" + synopsis(command) + ".SH OPTIONS\n";
    for (const CLI::Option* option : all_options_of(command)) {
        page += entry(spelled(*option), option->get_description());
    }
    const auto below = commands_of(command);
    page += below.empty() ? "" : ".SH COMMANDS\n";
    for (const CLI::App* one : below) {
        page += entry(full_name(*one), one->get_description());
    }
    if (!command.get_footer().empty()) {
        page += ".SH EXIT STATUS\n" + in_roff(command.get_footer()) + "\n";
    }
    return page;
}

/// Every command below the program with its options, as one page.
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
        "The program prints this page (`cmake --build build --target docs`). `{0} COMMAND --help` prints the help of "
        "one\n"
        "command, `{0} manual COMMAND | man -l -` shows it as a manual page, and `{0} completion bash` completes "
        "command lines.\n\n"
        "| command | |\n| --- | --- |\n{1}\n{2}\n{3}",
        program.get_name(), contents, program.get_footer(), sections);
}

const CLI::App& command_named(const CLI::App& program, const std::vector<std::string>& names) {
    const CLI::App* command = &program;
    for (const std::string& name : names) {
        const auto below = commands_of(*command);
        const auto found =
            std::find_if(below.begin(), below.end(), [&name](const CLI::App* one) { return one->get_name() == name; });
        if (found == below.end()) {
            throw UsageError("there is no command '{} {}'", full_name(*command), excerpt(name));
        }
        command = *found;
    }
    return *command;
}

struct ManualArguments {
    const CLI::App* program = nullptr;
    std::vector<std::string> names;
    std::optional<std::string> all;
    bool is_markdown = false;
};

ExitCode print_manual(const ManualArguments& given) {
    if (given.all) {
        const OutputFolder pages(*given.all);
        for_each_command(*given.program, [&pages](const CLI::App& command) {
            pages.write(with_dashes(full_name(command)) + ".1", man_page(command));
        });
    } else {
        fmt::print("{}", given.is_markdown ? markdown_page(*given.program)
                                           : man_page(command_named(*given.program, given.names)));
    }
    return ExitCode::done;
}

struct CompletionArguments {
    const CLI::App* program = nullptr;
    std::string shell;
};

ExitCode print_completion(const CompletionArguments& given) {
    fmt::print("{}", completion_script(*given.program, given.shell));
    return ExitCode::done;
}

}  // namespace

void add_manual(CLI::App& program, Action& action) {
    auto [command, given] = add_command(
        program, action, "manual",
        "Print the manual page of a command (downwash manual solve | man -l -) or, without one, of the program",
        print_manual);
    given.program = &program;
    CLI::Option* one = command.add_option("COMMAND", given.names, "the command, for example: aeromap plot");
    CLI::Option* pages = add_value(command, "--all DIR", given.all,
                                   "write the pages of all commands to a folder instead: downwash-solve.1...")
                             ->excludes(one);
    command.add_flag("--markdown", given.is_markdown, "Markdown instead of text; all commands as one page")
        ->excludes(one)
        ->excludes(pages);
}

void add_completion(CLI::App& program, Action& action) {
    auto [command, given] = add_command(
        program, action, "completion",
        "Print a script that completes command lines in a shell: source <(downwash completion bash)", print_completion);
    given.program = &program;
    require_one_of(*command.add_option("SHELL", given.shell, "bash or zsh")->required(), {"bash", "zsh"});
}

}  // namespace downwash::cli
