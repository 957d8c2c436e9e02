#include "downwash/cli/planner_options.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

struct PlannerOption {
    std::string_view name, key, placeholder;
    std::string_view meaning;  ///< that other commands share; empty: as in the table of parameters
    std::string_view note;
};

constexpr std::array planner_options{
    PlannerOption{"--variant", "planner.variant", "V", "", ""},
    PlannerOption{"--algorithm", "planner.algorithm", "A", "", ""},
    PlannerOption{"--objective", "planner.objective", "O", "", ", or weights as in energy=1,time=50"},
    PlannerOption{"--seed", "planner.seed", "N", "seed of the random numbers; ", ""},
    PlannerOption{"--time-limit", "planner.time_limit_s", "S", "wall time of a search [s]; ", ""},
    PlannerOption{"--max-iterations", "planner.max_iterations", "N", "",
                  "; without --time-limit it lifts the file's time limit"},
    PlannerOption{"--margin", "planner.safety_margin_m", "M", "", ""},
    PlannerOption{"--check-execution", "planner.check_execution", "true|false", "", ""},
    PlannerOption{"--certify", "planner.certify", "true|false", "", ""},
};

/// Reads "energy=1,time=50".
/// @throws InputError
CostFunction weighted_objective(const std::string& text) {
    const auto reject = [&text](const std::string& hint = "") {
        throw InputError(
            {{"planner.objective",
              "is '" + excerpt(text) + "': expected weights from 0 to 1e9 as in energy=1,time=50" + hint}});
    };
    constexpr double max_weight = 1e9;
    std::vector<std::string_view> names;
    names.reserve(all_objectives.size());
    for (const Objective objective : all_objectives) {
        names.push_back(name_of(objective));
    }
    CostFunction cost = CostFunction::of_nothing();
    std::vector<std::string_view> seen;
    std::string_view rest = text;
    while (true) {
        const std::string_view part = rest.substr(0, rest.find(','));
        const std::size_t equals = part.find('=');
        const std::string_view name = trimmed(part.substr(0, equals));
        const auto known = std::find(names.begin(), names.end(), name);
        if (known == names.end()) {
            reject(did_you_mean(name, names));
        }
        const auto weight = equals == std::string_view::npos ? std::optional<double>(1)
                                                             : parse_number<double>(trimmed(part.substr(equals + 1)));
        if (!weight || !(*weight >= 0 && *weight <= max_weight) ||
            std::find(seen.begin(), seen.end(), name) != seen.end()) {
            reject();
        }
        seen.push_back(name);
        cost.weight(all_objectives[static_cast<std::size_t>(known - names.begin())]) = *weight;
        if (part.size() == rest.size()) {
            return cost;
        }
        rest.remove_prefix(part.size() + 1);
    }
}

void set(Problem& problem, const PlannerOption& option, const std::string& text) {
    if (option.key == "planner.objective" && text.find_first_of("=,") != std::string::npos) {
        problem.planner.objective = weighted_objective(text);
    } else {
        set_parameter(problem, option.key, text);
    }
}

}  // namespace

void PlannerOptions::add(Command command, std::string_view key) {
    const auto option = *std::find_if(planner_options.begin(), planner_options.end(),
                                      [key](const PlannerOption& known) { return known.key == key; });
    const ParameterInfo& known = *problem_parameters().find(key);
    ParameterInfo parameter = known;
    parameter.can_be_group = false;  // an option is a word
    const auto take = [this, key = option.key](const std::string& text) { given_[key] = text; };
    static const std::vector<std::string_view> flag_words{"true", "false"};
    command
        .add_text(fmt::format("{} {}", option.name, option.placeholder), take,
                  fmt::format("{}{}: {}{} [{}]", option.meaning, parameter.description, expectation(parameter),
                              option.note, option.key))
        .offers(parameter.kind == ParameterKind::flag ? flag_words : parameter.names);
}

void PlannerOptions::add_of_search(Command command) {
    for (const std::string_view key :
         {"planner.variant", "planner.algorithm", "planner.objective", "planner.seed", "planner.time_limit_s",
          "planner.max_iterations", "planner.safety_margin_m", "planner.check_execution", "planner.certify"}) {
        add(command, key);
    }
}

void PlannerOptions::apply_to(Problem& problem) const {
    if (given_.contains("planner.max_iterations") && !given_.contains("planner.time_limit_s")) {
        problem.planner.time_limit_s.reset();
    }
    std::string messages;
    for (const PlannerOption& option : planner_options) {
        try {
            if (const auto text = given_.find(option.key); text != given_.end()) {
                set(problem, option, text->second);
            }
        } catch (const InputError& error) {
            for (const KeyError& of : error.errors()) {
                messages += fmt::format("{}{} {}", messages.empty() ? "" : "\n", option.name, of.message);
            }
        }
    }
    if (!messages.empty()) {
        throw UsageError(messages);
    }
}

void PlannerOptions::apply_to(SpaceProblem& problem) const {
    Problem settings;  // both families have the same
    settings.planner = problem.planner;
    apply_to(settings);
    problem.planner = settings.planner;
}

}  // namespace downwash::cli
