#pragma once

// Private to problems/.

#include <vector>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// The rows below `aero`, but for the map.
[[nodiscard]] std::vector<Parameter<AeroSettings>> aero_rows();

/// The group that `none` switches off. @pre a Model has aero
template <class Model>
[[nodiscard]] Parameter<Model> aero_group() {
    auto group = parameters::group<Model>("aero", "how surfaces act on the rotors").or_none();
    group.count = [](const Model& model, std::size_t) { return std::size_t{model.aero.enabled ? 1U : 0U}; };
    group.resize = [](Model& model, std::size_t, std::size_t count) { model.aero.enabled = count > 0; };
    return group;
}

/// Adds aero with everything in it to a planar problem's table.
/// @pre the rows of environment.plane stand before: a grid in plane coordinates is read with that plane
void add_aero_rows(std::vector<Parameter<Problem>>& rows);

}  // namespace downwash
