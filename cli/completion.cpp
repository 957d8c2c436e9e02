#include "downwash/cli/completion.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <vector>

#include "downwash/base/embedded_file.hpp"
#include "downwash/cli/command_walk.hpp"

DOWNWASH_EMBED_FILE(downwash_completion, DOWNWASH_COMPLETION);

namespace downwash::cli {
namespace {

template <class Words>
std::string joined(const Words& words) {
    return fmt::format("{}", fmt::join(words, " "));
}

/// CLI11 does not store words to offer; offer_words() makes them the name of an option's only check.
std::string offered_words(const CLI::Option& option) {
    try {
        // Only the getter is not const. NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
        return const_cast<CLI::Option&>(option).get_validator()->get_name();
    } catch (const CLI::OptionNotFound&) {
        return {};  // it has no check
    }
}

std::vector<std::string> spellings(const CLI::Option& option) {
    std::vector<std::string> all;
    for (const std::string& name : option.get_lnames()) {
        all.push_back("--" + name);
    }
    for (const std::string& name : option.get_snames()) {
        all.push_back("-" + name);
    }
    return all;
}

/// What may follow a command: names of commands, words, and options.
std::string words_after(const CLI::App& command) {
    std::vector<std::string> words;
    for (const CLI::App* below : commands_of(command)) {
        words.push_back(below->get_name());
    }
    for (const CLI::Option* option : options_of(command, true)) {
        if (std::string offered = offered_words(*option); !offered.empty()) {
            words.push_back(std::move(offered));
        }
    }
    for (const CLI::Option* option : options_of(command, false)) {
        for (const std::string& name : option->get_lnames()) {
            words.push_back("--" + name);
        }
    }
    return joined(words);
}

std::string case_of(const CLI::App& command, const CLI::Option& option, const std::string& next) {
    std::vector<std::string> patterns;
    for (const std::string& spelling : spellings(option)) {
        patterns.push_back(fmt::format("'{} {}'", full_name(command), spelling));
    }
    return fmt::format("{}) next='{}' ;;\n", fmt::join(patterns, " | "), next);
}

/// As cases of a shell script: what follows an option that takes values; its words, or else a file.
/// @param is_after_value whether a value was given and more may follow: then words of the command follow, too
std::string cases_of_options(const CLI::App& program, bool is_after_value) {
    std::string cases;
    for_each_command(program, [&](const CLI::App& command) {
        for (const CLI::Option* option : options_of(command, false)) {
            const std::string offered = offered_words(*option);
            if (is_after_value && option->get_items_expected_max() > 1 && !offered.empty()) {
                cases += "            " + case_of(command, *option, offered + " " + words_after(command));
            } else if (!is_after_value && option->get_items_expected_max() > 0) {
                cases += "        " + case_of(command, *option, offered);
            }
        }
    });
    return cases;
}

/// The same: what follows a command.
std::string cases_of_commands(const CLI::App& program) {
    std::string cases;
    for_each_command(program, [&cases](const CLI::App& command) {
        cases += fmt::format("                '{}') next='{}' ;;\n", full_name(command), words_after(command));
    });
    return cases;
}

std::string names_of_commands(const CLI::App& program) {
    std::vector<std::string> names;
    for_each_command(program, [&names](const CLI::App& command) {
        if (command.get_parent() != nullptr) {
            names.push_back("'" + full_name(command) + "'");
        }
    });
    return fmt::format("{}", fmt::join(names, " | "));
}

}  // namespace

void offer_words(CLI::Option& option, std::span<const std::string_view> words) {
    option.check(CLI::Validator([](std::string& /*text*/) { return std::string(); }, "", joined(words)));
}

void require_one_of(CLI::Option& option, const std::vector<std::string_view>& words) {
    option.type_name(fmt::format("{}", fmt::join(words, "|")));
    option.check(CLI::IsMember(std::vector<std::string>(words.begin(), words.end())), joined(words));
}

std::string completion_script(const CLI::App& program, const std::string& shell) {
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
