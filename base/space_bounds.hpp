#pragma once

#include "downwash/base/vector3.hpp"

namespace downwash {

/// A box of the world [m]: where the multirotor's centre of mass may be.
struct SpaceBounds {
    Vector3 low_m = {}, high_m = {};  ///< low < high in each coordinate
};

}  // namespace downwash
