#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
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
std::string spelled(const Option& option) {
    std::string text = option.spelling();
    if (!option.is_positional() && option.max_values() > 0) {
        text += " " + option.type();
    }
    text.erase(std::min(text.find(':'), text.size()));  // a check follows, which the description says too
    return text;
}

/// An entry of a list in a manual page.
std::string entry(const std::string& name, const std::string& description) {
    return fmt::format(".TP\n.B {}\n{}\n", in_roff(name), in_roff(description));
}

std::string synopsis(const Command& command) {
    std::string text = ".B " + in_roff(command.full_name()) + "\n";
    if (!command.commands().empty()) {
        return text + "COMMAND\n";
    }
    for (const Option& option : command.options()) {
        if (option.is_positional()) {
            text += in_roff(option.name()) + (option.max_values() > 1 ? "...\n" : "\n");
        }
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

std::string markdown_options(const Command& command) {
    std::string rows;
    for (const Option& option : command.options()) {
        if (option.name() == "--help") {
            continue;
        }
        const std::string name = spelled(option);
        const std::string standard = option.default_text();
        rows += fmt::format("| `{}` | {}{}{} |\n", in_cell(name), in_cell(option.description()),
                            standard.empty() ? "" : "; default " + in_cell(standard),
                            option.is_required() && !option.is_positional() ? " (required)" : "");
    }
    return rows.empty() ? "" : "\n| | |\n| --- | --- |\n" + rows;
}

/// The page of a command for man(1), or of the whole program.
std::string man_page(const Command& command) {
    const std::string name = with_dashes(command.full_name());
    std::string title = name;
    std::transform(title.begin(), title.end(), title.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    std::string page = fmt::format(".TH {} 1 \"\" \"Downwash {}\" \"Downwash\"\n", title, version());
    page += fmt::format(".SH NAME\n{} \\- {}\n", in_roff(name), in_roff(command.description()));
    page += ".SH SYNOPSIS\n" + synopsis(command) + ".SH OPTIONS\n";
    for (const Option& option : command.options()) {
        page += entry(spelled(option), option.description());
    }
    const auto below = command.commands();
    page += below.empty() ? "" : ".SH COMMANDS\n";
    for (const Command& one : below) {
        page += entry(one.full_name(), one.description());
    }
    if (!command.footer().empty()) {
        page += ".SH EXIT STATUS\n" + in_roff(command.footer()) + "\n";
    }
    return page;
}

/// Every command below the program with its options, as one page.
std::string markdown_page(const Command& program) {
    std::string contents;
    std::string sections;
    for_each_command(program, [&](const Command& command) {
        if (command.is_program()) {
            return;
        }
        const std::string name = command.full_name();
        contents += fmt::format("| [`{}`](#{}) | {} |\n", name, with_dashes(name), in_cell(command.description()));
        sections += fmt::format("\n## {}\n\n{}.\n\n```\n{}\n```\n{}", name, command.description(), command.usage(),
                                markdown_options(command));
    });
    return fmt::format(
        "# Commands\n\n"
        "The program prints this page (`cmake --build build --target docs`). `{0} COMMAND --help` prints the help of "
        "one\n"
        "command, `{0} manual COMMAND | man -l -` shows it as a manual page, and `{0} completion bash` completes "
        "command lines.\n\n"
        "| command | |\n| --- | --- |\n{1}\n{2}\n{3}",
        program.name(), contents, program.footer(), sections);
}

Command command_named(const Command& program, const std::vector<std::string>& names) {
    Command command = program;
    for (const std::string& name : names) {
        const auto below = command.commands();
        const auto found =
            std::find_if(below.begin(), below.end(), [&name](const Command& one) { return one.name() == name; });
        if (found == below.end()) {
            throw UsageError("there is no command '{} {}'", command.full_name(), excerpt(name));
        }
        command = *found;
    }
    return command;
}

struct ManualArguments {
    Command program;
    std::vector<std::string> names;
    std::optional<std::string> all;
    bool is_markdown = false;
};

ExitCode print_manual(const ManualArguments& given) {
    if (given.all) {
        const OutputFolder pages(*given.all);
        for_each_command(given.program, [&pages](const Command& command) {
            pages.write(with_dashes(command.full_name()) + ".1", man_page(command));
        });
    } else {
        fmt::print("{}", given.is_markdown ? markdown_page(given.program)
                                           : man_page(command_named(given.program, given.names)));
    }
    return ExitCode::done;
}

struct CompletionArguments {
    Command program;
    std::string shell;
};

ExitCode print_completion(const CompletionArguments& given) {
    fmt::print("{}", completion_script(given.program, given.shell));
    return ExitCode::done;
}

}  // namespace

void add_manual(Command program, Action& action) {
    auto [command, given] = add_command(
        program, action, "manual",
        "Print the manual page of a command (downwash manual solve | man -l -) or, without one, of the program",
        print_manual);
    given.program = program;
    Option one = command.add_option("COMMAND", given.names, "the command, for example: aeromap plot");
    Option pages = command
                       .add_option("--all DIR", given.all,
                                   "write the pages of all commands to a folder instead: downwash-solve.1...")
                       .excludes(one);
    command.add_flag("--markdown", given.is_markdown, "Markdown instead of text; all commands as one page")
        .excludes(one)
        .excludes(pages);
}

void add_completion(Command program, Action& action) {
    auto [command, given] = add_command(
        program, action, "completion",
        "Print a script that completes command lines in a shell: source <(downwash completion bash)", print_completion);
    given.program = program;
    command.add_option("SHELL", given.shell, "bash, zsh or fish").required().one_of({"bash", "zsh", "fish"});
}

}  // namespace downwash::cli
