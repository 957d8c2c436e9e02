#pragma once

// Private: not installed.

#include <vector>

#include "downwash/report/picture.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// What is seen of a robot's bodies from beside: one convex ring each, in its own frame.
[[nodiscard]] std::vector<std::vector<PlanePoint>> body_outlines(const std::vector<BodyShape>& bodies);

}  // namespace downwash
