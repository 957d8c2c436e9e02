#include "downwash/simulation/space_loop_of.hpp"

namespace downwash::simulation {

template <>
std::unique_ptr<SpaceLoop> make_space_loop_of<2>(const SpaceLoopSetup& setup) {
    return std::make_unique<SpaceLoopOf<2>>(setup);
}

}  // namespace downwash::simulation
