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
    if (given_.contains("--max-iterations") && !given_.contains("--time-limit")) {
        problem.planner.time_limit_s.reset();
    }
    std::string messages;
    for (const OptionOfKey& option : options) {
        const auto text = given_.find(std::string(option.option));
        if (text == given_.end()) {
            continue;
        }
        try {
            set_parameter(problem, option.key, text->second);
        } catch (const InputError& error) {
            for (const KeyError& of : error.errors()) {
                messages += fmt::format("{}{} {}", messages.empty() ? "" : "\n", option.option, of.message);
            }
        }
    }
    if (!messages.empty()) {
        throw UsageError(messages);
    }
}

}  // namespace downwash::cli
