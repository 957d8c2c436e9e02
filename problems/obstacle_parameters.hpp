#pragma once

// Private to problems/.

#include <vector>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// From the origin [m]; farther out, positions lose their millimetres.
inline constexpr double farthest_m = 1e5;

/// The rows of a list of obstacles, from "obstacles" on.
[[nodiscard]] std::vector<Parameter<std::vector<Obstacle>>> obstacle_rows();

/// Adds environment.obstacles with everything in it to a problem's table. @pre a Model has obstacles
template <class Model>
void add_obstacle_rows(std::vector<Parameter<Model>>& rows) {
    for (const auto& row : obstacle_rows()) {
        rows.push_back(parameters::nested<Model>(row, "environment.", &Model::obstacles));
    }
}

}  // namespace downwash
