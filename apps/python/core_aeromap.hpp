#pragma once

#include <cstddef>
#include <map>
#include <memory>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/python/core.hpp"

namespace downwash::python {

/// An aero map and the vehicle whose rotors it is of.
struct CoreMap {
    std::shared_ptr<const AeroMap> map;
    std::shared_ptr<const FlightModel> model;
    std::map<std::size_t, MapArrays> arrays = {};  ///< of the layers that were asked for

    /// Fills the map and copies a layer, once.
    const MapArrays& arrays_of_layer(std::size_t layer);
};

}  // namespace downwash::python
