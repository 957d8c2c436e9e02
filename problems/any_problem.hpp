#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/located_error.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// A problem in a vertical plane or in space.
using AnyProblem = std::variant<Problem, SpaceProblem>;

[[nodiscard]] inline const std::string& problem_name(const AnyProblem& problem) {
    return std::visit([](const auto& of) -> const std::string& { return of.name; }, problem);
}

[[nodiscard]] inline PlannerSettings& planner_of(AnyProblem& problem) {
    return std::visit([](auto& of) -> PlannerSettings& { return of.planner; }, problem);
}
[[nodiscard]] inline const PlannerSettings& planner_of(const AnyProblem& problem) {
    return std::visit([](const auto& of) -> const PlannerSettings& { return of.planner; }, problem);
}

[[nodiscard]] inline std::optional<Uncertainty>& uncertainty_of(AnyProblem& problem) {
    return std::visit([](auto& of) -> std::optional<Uncertainty>& { return of.uncertainty; }, problem);
}
[[nodiscard]] inline const std::optional<Uncertainty>& uncertainty_of(const AnyProblem& problem) {
    return std::visit([](const auto& of) -> const std::optional<Uncertainty>& { return of.uncertainty; }, problem);
}

/// A digest of everything that makes up a problem.
[[nodiscard]] DOWNWASH_EXPORT std::string problem_sha256(const AnyProblem& problem);

/// What else may be wrong with a sound problem in space, for whoever reads it.
using FurtherSpaceErrors = std::function<std::vector<KeyError>(const SpaceProblem&)>;

/// Reads a problem of either family.
/// @param on_outdated is told of keys by their former names, on_warning of what is likely not meant
/// @throws ProblemFileError as read_problem() and read_space_problem()
[[nodiscard]] DOWNWASH_EXPORT AnyProblem read_any_problem(
    const std::filesystem::path& file, const std::function<void(const LocatedError&)>& on_outdated = {},
    const std::function<void(const LocatedError&)>& on_warning = {}, const FurtherSpaceErrors& further_errors = {});

}  // namespace downwash
