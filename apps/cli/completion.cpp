#include "downwash/cli/completion.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "downwash/base/embedded_file.hpp"
#include "downwash/base/text.hpp"

DOWNWASH_EMBED_FILE(downwash_completion, DOWNWASH_COMPLETION);

namespace downwash::cli {
namespace {

/// What may follow a command: names of commands, words, and options.
std::string words_after(const Command& command) {
    std::vector<std::string> words;
    for (const Command& below : command.commands()) {
        words.push_back(below.name());
    }
    for (const Option& option : command.options()) {
        if (std::string offered = option.offered_words(); option.is_positional() && !offered.empty()) {
            words.push_back(std::move(offered));
        }
        for (const std::string& name : option.names()) {
            if (name.starts_with("--")) {
                words.push_back(name);
            }
        }
    }
    return joined(words, " ");
}

std::string case_of(const Command& command, const Option& option, const std::string& next) {
    std::vector<std::string> patterns;
    for (const std::string& name : option.names()) {
        patterns.push_back(fmt::format("'{} {}'", command.full_name(), name));
    }
    return fmt::format("{}) next='{}' ;;\n", fmt::join(patterns, " | "), next);
}

/// As cases of a shell script: what follows an option that takes values; its words, or else a file.
/// @param is_after_value whether a value was given and more may follow: then words of the command follow, too
std::string cases_of_options(const Command& program, bool is_after_value) {
    std::string cases;
    for_each_command(program, [&](const Command& command) {
        for (const Option& option : command.options()) {
            const std::string offered = option.offered_words();
            if (option.is_positional()) {
                continue;
            }
            if (is_after_value && option.max_values() > 1 && !offered.empty()) {
                cases += "            " + case_of(command, option, offered + " " + words_after(command));
            } else if (!is_after_value && option.max_values() > 0) {
                cases += "        " + case_of(command, option, offered);
            }
        }
    });
    return cases;
}

/// The same: what follows a command.
std::string cases_of_commands(const Command& program) {
    std::string cases;
    for_each_command(program, [&cases](const Command& command) {
        cases += fmt::format("                '{}') next='{}' ;;\n", command.full_name(), words_after(command));
    });
    return cases;
}

std::string names_of_commands(const Command& program) {
    std::vector<std::string> names;
    for_each_command(program, [&names](const Command& command) {
        if (!command.is_program()) {
            names.push_back("'" + command.full_name() + "'");
        }
    });
    return fmt::format("{}", fmt::join(names, " | "));
}

/// Text between single quotes as fish reads it.
std::string in_fish_quotes(std::string_view text) {
    std::string quoted = "'";
    for (const char letter : text) {
        quoted += letter == '\'' || letter == '\\' ? std::string{'\\', letter} : std::string(1, letter);
    }
    return quoted + "'";
}

/// A line of fish's: what may follow a command.
/// @param what as options of fish's `complete`   @param description of which the first line is shown
std::string fish_line(const Command& command, const std::string& what, const std::string& description) {
    return fmt::format("complete -c downwash -n {} {} -d {}\n",
                       in_fish_quotes("test (__downwash_command) = \"" + command.full_name() + "\""), what,
                       in_fish_quotes(description.substr(0, description.find('\n'))));
}

/// What fish's `complete` offers for words; files with some endings come before others.
std::string fish_words(const std::string& offered) {
    if (!offered.starts_with('@')) {
        return "-f -a " + in_fish_quotes(offered);
    }
    std::string endings = offered;
    std::erase(endings, '@');
    return "-f -k -a " + in_fish_quotes("(__fish_complete_suffix " + endings + ")");
}

std::string fish_option(const Option& option) {
    std::string text;
    for (const std::string& name : option.names()) {
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    const std::string offered = option.offered_words();
    if (option.max_values() > 0) {
        text += offered.empty() ? " -r" : " -r " + fish_words(offered);
    }
    return text.substr(1);
}

std::string fish_script(const Command& program) {
    std::string script =
        "# Completes the commands and options of downwash, the values of options, and file names.\n"
        "function __downwash_command\n"
        "    set -l given downwash\n"
        "    for word in (commandline -opc)[2..-1]\n"
        "        if contains -- \"$given $word\"";
    for_each_command(program, [&script](const Command& command) {
        script += command.is_program() ? "" : " " + in_fish_quotes(command.full_name());
    });
    script +=
        "\n            set given \"$given $word\"\n"
        "        end\n"
        "    end\n"
        "    echo $given\n"
        "end\n";
    for_each_command(program, [&script](const Command& command) {
        for (const Command& below : command.commands()) {
            script += fish_line(command, "-f -a " + in_fish_quotes(below.name()), below.description());
        }
        for (const Option& option : command.options()) {
            if (!option.is_positional()) {
                script += fish_line(command, fish_option(option), option.description());
            } else if (!option.offered_words().empty()) {
                script += fish_line(command, fish_words(option.offered_words()), option.description());
            }
        }
    });
    return script;
}

}  // namespace

std::string completion_script(const Command& program, const std::string& shell) {
    if (shell == "fish") {
        return fish_script(program);
    }
    std::string script(DOWNWASH_EMBEDDED_FILE(downwash_completion));
    const auto fill = [&script](std::string_view gap, const std::string& text) {
        script.replace(script.find(gap), gap.size(), text);
    };
    fill("@commands@", names_of_commands(program));
    fill("@values@", cases_of_options(program, false));
    fill("@more_values@", cases_of_options(program, true));
    fill("@words@", cases_of_commands(program));
    if (shell != "zsh") {
        return script;
    }
    // If zsh finds the script on its path of functions, all of it is the body of the first call.
    return "#compdef downwash\nautoload -U +X bashcompinit && bashcompinit\n" + script +
           "[[ ${funcstack[1]} != _downwash ]] || _bash_complete -o filenames -F _downwash\n";
}

}  // namespace downwash::cli
