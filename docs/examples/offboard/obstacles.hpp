#pragma once

#include <algorithm>
#include <string>
#include <variant>

#include <downwash/base/key_error.hpp>
#include <downwash/problems/space_problem.hpp>

/// The box of that name in a problem. @throws downwash::InputError if there is none
inline downwash::Obstacle& box_in(downwash::SpaceProblem& problem, const std::string& name) {
    const auto found = std::ranges::find(problem.obstacles, name, &downwash::Obstacle::name);
    if (found == problem.obstacles.end() || !std::holds_alternative<downwash::Box>(found->shape)) {
        downwash::throw_input_error("has no box called '" + name + "'", "environment.obstacles");
    }
    return *found;
}
