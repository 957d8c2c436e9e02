#include <cstddef>
#include <cstdint>

#include "../support/random.hpp"
#include "downwash/aeromap/aero_map.hpp"

/// Whatever passes for a map answers everywhere without leaving its memory. The digest of a cache file is left out: no
/// fuzzer would ever find one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace downwash;
    static const PlaneOfMotion plane;
    static const Bounds extent{0, 0.3, 0.1, 0.4};
    static const std::vector<MapLayer> layers = [] {
        AeroSettings settings;
        settings.grid_m = 0.1;
        Obstacle ground;
        ground.shape = Box{{4, 4, 1}};
        ground.center_world_m = {0, 0, -0.5};
        const auto scene = std::make_shared<const Scene>(std::vector<Obstacle>{ground});
        const auto effect = std::make_shared<const DirectEffect>(scene, settings, 0.3);
        return std::vector<MapLayer>{{effect, 0}, {effect, 0.1}};  // of equal values
    }();
    const auto map = AeroMap::from_bytes(layers, plane, extent, {reinterpret_cast<const char*>(data), size});
    if (map) {
        test::Random random(1);
        for (int i = 0; i < 1000; ++i) {
            const double x = random.uniform(-0.1, 0.4);
            const double z = random.uniform(0, 0.5);
            for (const std::size_t layer : {std::size_t{0}, std::size_t{1}}) {
                static_cast<void>(map->factor(layer, x, z));
                static_cast<void>(map->is_flyable(layer, x, z));
            }
        }
    }
    return 0;
}
