#include "downwash/cli/planner_options.hpp"

#include <fmt/core.h>

#include <array>

#include "downwash/base/key_error.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

struct OptionOfKey {
    std::string_view option;
    std::string_view key;
    std::string_view placeholder;
    std::string_view note;
};

constexpr std::array options{
    OptionOfKey{"--variant", "planner.variant", "V", ""},
    OptionOfKey{"--algorithm", "planner.algorithm", "A", ""},
    OptionOfKey{"--objective", "planner.objective", "O", ""},
    OptionOfKey{"--seed", "planner.seed", "N", ""},
    OptionOfKey{"--time-limit", "planner.time_limit_s", "S", ""},
    OptionOfKey{"--max-iterations", "planner.max_iterations", "N",
                "; without --time-limit it lifts the file's time limit"},
    OptionOfKey{"--margin", "planner.safety_margin_m", "M", ""},
};

std::string description(const OptionOfKey& option) {
    const ParameterInfo& known = *problem_parameters().find(option.key);
    ParameterInfo parameter = known;
    parameter.can_be_group = false;  // an option is a word
    return fmt::format("{}: {}{} [{}]", parameter.description, expectation(parameter), option.note, option.key);
}

/// A error in the words of the command line, where its key was given there.
std::string in_options(const KeyError& error, const std::map<std::string, std::string>& given) {
    for (const OptionOfKey& option : options) {
        if (error.key == option.key && given.contains(std::string(option.option))) {
            return fmt::format("{} {}", option.option, error.message);
        }
    }
    return fmt::format("{} {}", error.key, error.message);
}

}  // namespace

void PlannerOptions::add_to(CLI::App& command) {
    for (const OptionOfKey& option : options) {
        const std::string name(option.option);
        CLI::Option* added = command.add_option_function<std::string>(
            name, [this, name](const std::string& text) { given_[name] = text; }, description(option));
        added->type_name(std::string(option.placeholder));
        offer_words(*added, problem_parameters().find(option.key)->names);
    }
}

void PlannerOptions::apply(Problem& problem) const {
    std::string refused;
    const auto refuse = [&](const std::vector<KeyError>& errors) {
        for (const KeyError& error : errors) {
            refused += (refused.empty() ? "" : "\ndownwash: ") + in_options(error, given_);
        }
    };
    if (given_.contains("--max-iterations") && !given_.contains("--time-limit")) {
        problem.planner.time_limit_s.reset();
    }
    for (const OptionOfKey& option : options) {
        const auto text = given_.find(std::string(option.option));
        if (text == given_.end()) {
            continue;
        }
        try {
            set_parameter(problem, option.key, text->second);
        } catch (const InputError& error) {
            refuse(error.errors());
        }
    }
    if (!refused.empty()) {
        throw UsageError(refused);
    }
}

}  // namespace downwash::cli
