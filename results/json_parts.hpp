#pragma once

// Private to results/.

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <vector>

#include "downwash/problems/located_error.hpp"
#include "downwash/problems/objective.hpp"
#include "downwash/simulation/contact_goal.hpp"

// Parts of solution.json that plane and space share.

namespace downwash {

/// Null for what is not finite: JSON knows no infinity and no NaN.
[[nodiscard]] nlohmann::ordered_json json_number(double value);
[[nodiscard]] nlohmann::ordered_json json_number(const std::optional<double>& value);

/// The value of `warnings`.
[[nodiscard]] nlohmann::ordered_json warnings_json(const std::vector<LocatedError>& warnings);

/// The value of `objective`: a name, or the weights of a sum.
[[nodiscard]] nlohmann::ordered_json objective_json(const CostFunction& objective);

/// What became of a touch, as a group.
[[nodiscard]] nlohmann::ordered_json touch_json(const TouchRecord& touch);

}  // namespace downwash
