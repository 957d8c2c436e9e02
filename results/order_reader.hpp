#pragma once

// Private to results/.

#include <optional>

#include "downwash/problems/visit_order.hpp"
#include "downwash/results/json_reader.hpp"

namespace downwash::problems {

/// Reads `order`, in which a plan visits the targets of a problem; errors go to the reader. Where a plan written by
/// hand does not tell, it is the order of the problem. Empty where the problem has no targets.
[[nodiscard]] std::optional<VisitOrder> read_order(JsonReader& reader, const Node& root, const Problem& problem);
/// The same in space. Also empty where a plan does not tell and shows it: leaves_order_open().
[[nodiscard]] std::optional<VisitOrder> read_order(JsonReader& reader, const Node& root, const SpaceProblem& problem);

}  // namespace downwash::problems
