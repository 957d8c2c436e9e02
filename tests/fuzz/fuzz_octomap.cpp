#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "downwash/base/key_error.hpp"
#include "downwash/scene/octomap_file.hpp"

/// Whatever is read lies within the space that a tree can span.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const downwash::OccupancyTree tree =
            downwash::parse_octomap({reinterpret_cast<const char*>(data), size}, "tree.bt");
        for (const downwash::OccupiedCube& cube : tree.cubes) {
            for (const double x_m : cube.center_local_m) {
                if (!(std::abs(x_m) + cube.side_m / 2 <= 1.0001 * 32768 * tree.resolution_m)) {
                    std::abort();
                }
            }
        }
    } catch (const downwash::InputError&) {
    }
    return 0;
}
