#include "downwash/simulation/space_hover_loop_of.hpp"

namespace downwash::simulation {

template <>
std::unique_ptr<SpaceHoverLoop> make_space_hover_loop_of<2>(const SpaceRobot& robot, const SpaceAero& aero,
                                                            SpaceEffect& surfaces) {
    return std::make_unique<SpaceHoverLoopOf<2>>(robot, aero, surfaces);
}

}  // namespace downwash::simulation
