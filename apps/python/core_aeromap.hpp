#pragma once

#include <memory>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/python/core.hpp"

namespace downwash::python {

/// An aero map and the vehicle whose rotors it is of.
struct CoreMap {
    std::shared_ptr<const AeroMap> map;
    std::shared_ptr<const FlightModel> model;
};

}  // namespace downwash::python
