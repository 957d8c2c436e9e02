#pragma once

// Private to simulation/.

#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash {

/// Adds `controller` with everything in it to the table of a robot in space.
void add_space_controller_rows(std::vector<Parameter<SpaceRobot>>& rows);

}  // namespace downwash
