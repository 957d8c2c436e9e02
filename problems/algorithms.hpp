#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// A number that an algorithm works with: `planner.parameters.NAME` of a problem file sets it.
struct AlgorithmParameter {
    std::string_view name;  ///< OMPL's name, where the parameter is OMPL's
    double value;           ///< the default
    double low, high;       ///< smallest and largest value that makes sense
    std::string_view description;
    bool is_whole = false;  ///< only whole numbers make sense
};

/// One search algorithm.
struct AlgorithmInfo {
    std::string_view name;
    std::string_view kind;  ///< "geometric, anytime", ...
    std::string_view description;
    bool plans_lines = false;    ///< whether it plans for mp-arm
    bool plans_flights = false;  ///< whether it plans for mp-arm-da and mp-arm-ada
    std::span<const AlgorithmParameter> line_parameters = {};
    std::span<const AlgorithmParameter> flight_parameters = {};

    /// Whether a problem may name it together with a variant.
    [[nodiscard]] bool plans_for(Variant variant) const noexcept {
        return variant == Variant::mp_arm ? plans_lines : plans_flights;
    }
    /// What can be set when it plans for a variant.
    [[nodiscard]] std::span<const AlgorithmParameter> parameters_for(Variant variant) const noexcept {
        return variant == Variant::mp_arm ? line_parameters : flight_parameters;
    }
};

/// Every algorithm that a problem may name.
[[nodiscard]] DOWNWASH_EXPORT std::span<const AlgorithmInfo> algorithms();

/// Their names, in the same order.
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::string_view> algorithm_names();

/// A parameter by its name, and the algorithms that have it.
struct KnownParameter {
    const AlgorithmParameter* parameter;
    std::vector<std::string_view> algorithms;
};

/// Every name that `planner.parameters` may have, in alphabetical order. Algorithms differ in the default of a name at
/// most, not in what it means.
[[nodiscard]] DOWNWASH_EXPORT const std::vector<KnownParameter>& known_parameters();

/// The parameters of a problem's algorithm and variant; none for an algorithm that does not exist.
[[nodiscard]] DOWNWASH_EXPORT std::span<const AlgorithmParameter> algorithm_parameters(const PlannerSettings& settings);

/// One of them by its name; nullptr when the algorithm has no such parameter.
[[nodiscard]] DOWNWASH_EXPORT const AlgorithmParameter* algorithm_parameter(const PlannerSettings& settings,
                                                                            std::string_view name);

/// The value of one of them: the problem's own, or the default.
/// @pre the algorithm has the parameter
[[nodiscard]] DOWNWASH_EXPORT double parameter_value(const PlannerSettings& settings, std::string_view name);

}  // namespace downwash
