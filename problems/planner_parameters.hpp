#pragma once

// Private to problems/.

#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// The rows below `planner`.
[[nodiscard]] std::vector<Parameter<PlannerSettings>> planner_rows();

/// Whether a row of them has a meaning only for problems with an uncertainty.
[[nodiscard]] bool is_about_uncertainty(std::string_view path);

/// Adds planner with everything in it to a problem's table. @pre a Model has planner and uncertainty
template <class Model>
void add_planner_rows(std::vector<Parameter<Model>>& rows) {
    rows.push_back(parameters::group<Model>("planner", "how to search"));
    for (const Parameter<PlannerSettings>& row : planner_rows()) {
        auto outer = parameters::nested<Model>(row, "planner.", &Model::planner);
        if (is_about_uncertainty(row.path)) {
            outer = std::move(outer).only(
                "with an uncertainty", [](const Model& model, std::size_t) { return model.uncertainty.has_value(); });
        }
        rows.push_back(std::move(outer));
    }
}

}  // namespace downwash
