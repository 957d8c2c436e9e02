#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../support/test_files.hpp"
#include "downwash/base/text.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/problem_parameters.hpp"

namespace downwash::test {

/// The names of what stands below a path of a problem file, or of those of which exactly one is expected.
inline std::vector<std::string_view> names_below(std::string_view path, bool only_exclusive) {
    std::vector<std::string_view> names;
    for (const Parameter<Problem>* row : problem_parameters().children(path)) {
        if (row->exclusive || !only_exclusive) {
            names.push_back(last_name(row->path));
        }
    }
    return names;
}

/// An expected text in which <objectives>, <models>, <algorithms> and <algorithms over flights> stand for all names
/// that there are, joined; <goals> for the kinds of a goal, any_of included, <stops> for those of an entry of a list of
/// goals, and <keys of a stop> for its keys; <targets> and <keys of a target> for those of a target in any order.
inline std::string with_all_names(std::string_view text) {
    std::vector<std::string_view> objectives, models, planners, flight_planners;
    for (const Objective objective : all_objectives) {
        objectives.push_back(name_of(objective));
    }
    for (const EffectModelInfo& model : effect_models()) {
        models.push_back(model.name);
    }
    for (const AlgorithmInfo& algorithm : algorithms()) {
        planners.push_back(algorithm.name);
        if (algorithm.plans_flights) {
            flight_planners.push_back(algorithm.name);
        }
    }
    const std::pair<std::string_view, std::vector<std::string_view>> all[] = {
        {"<objectives>", objectives},
        {"<models>", models},
        {"<algorithms>", planners},
        {"<algorithms over flights>", flight_planners},
        {"<goals>", names_below("goal", true)},
        {"<stops>", names_below("goal[]", true)},
        {"<keys of a stop>", names_below("goal[]", false)},
        {"<targets>", names_below("goal.in_any_order[]", true)},
        {"<keys of a target>", names_below("goal.in_any_order[]", false)},
    };
    std::string out(text);
    for (const auto& [word, names] : all) {
        for (std::size_t at = out.find(word); at != std::string::npos; at = out.find(word, at)) {
            out.replace(at, word.size(), joined_names(names));
        }
    }
    return out;
}

/// One change to a sound file and every error that it must lead to, line by line from the line's number on.
struct Edit {
    std::string_view from, to;
    std::string_view errors;  ///< see with_all_names

    /// The errors in a file.
    [[nodiscard]] std::string errors_in(const std::string& file) const {
        std::string text = file + ":";
        for (const char c : with_all_names(errors)) {
            text += c == '\n' ? "\n" + file + ":" : std::string(1, c);
        }
        return text;
    }
};

/// What reading the sound problem says after a change to its own file.
inline std::string errors_after(const TestFolder& folder, std::string_view from, std::string_view to) {
    return folder.errors_of(edited(good_problem, from, to), good_robot);
}

/// What reading the sound problem says after a change to its robot's file.
inline std::string errors_after_robot(const TestFolder& folder, std::string_view from, std::string_view to) {
    return folder.errors_of(good_problem, edited(good_robot, from, to));
}

/// Checks every edit of a file.
template <std::size_t count, class ErrorsAfter>
void check(const Edit (&edits)[count], const std::string& file, const ErrorsAfter& errors_after) {
    for (const Edit& edit : edits) {
        CAPTURE(edit.from, edit.to);
        CHECK(errors_after(edit.from, edit.to) == edit.errors_in(file));
    }
}

}  // namespace downwash::test
