#pragma once

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include <downwash/base/key_error.hpp>
#include <downwash/problems/problem.hpp>
#include <downwash/problems/problem_reader.hpp>

/// The box "deck" of a problem. @throws downwash::InputError if there is none
inline downwash::Obstacle& deck_of(downwash::Problem& problem) {
    const auto found = std::find_if(problem.obstacles.begin(), problem.obstacles.end(),
                                    [](const downwash::Obstacle& each) { return each.name == "deck"; });
    if (found == problem.obstacles.end() || !std::holds_alternative<downwash::Box>(found->shape)) {
        downwash::throw_input_error("has no box called 'deck'", "environment.obstacles");
    }
    return *found;
}

/// Reads a mission: a bridge with a deck, and a list of places for the end effector.
/// @throws downwash::InputError, downwash::ProblemFileError
inline downwash::Problem read_bridge(const std::string& file) {
    downwash::Problem problem = downwash::read_problem(file);
    deck_of(problem);
    const std::vector<downwash::Goal> targets = downwash::goals_of(problem);
    if (!problem.targets.empty() || !std::all_of(targets.begin(), targets.end(), [](const downwash::Goal& each) {
            return std::holds_alternative<downwash::EndEffectorGoal>(each.kind);
        })) {
        downwash::throw_input_error("is no list of places for the end effector, which a mission needs", "goal");
    }
    return problem;
}

/// Height of the deck's underside [m].
inline double underside_m(const downwash::Obstacle& deck) {
    return deck.center_world_m[2] - 0.5 * std::get<downwash::Box>(deck.shape).size_m[2];
}

/// Whether a target is part of the deck: less than 0.2 m below its underside.
inline bool hangs_on(const downwash::Obstacle& deck, const downwash::Goal& target) {
    return std::get<downwash::EndEffectorGoal>(target.kind).z_m > underside_m(deck) - 0.2;
}

/// Moves the deck down, and the targets that hang on it.
inline void lower_deck(downwash::Problem& problem, double by_m) {
    downwash::Obstacle& deck = deck_of(problem);
    const auto lower = [&](downwash::Goal& target) {
        if (hangs_on(deck, target)) {
            std::get<downwash::EndEffectorGoal>(target.kind).z_m -= by_m;
        }
    };
    std::for_each(problem.goals_before.begin(), problem.goals_before.end(), lower);
    lower(problem.goal);
    deck.center_world_m[2] -= by_m;
}
