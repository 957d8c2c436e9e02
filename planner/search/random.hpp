#pragma once

#include "downwash/base/random.hpp"

namespace downwash::planning {

/// The randomness of one search.
using downwash::Random;

}  // namespace downwash::planning
