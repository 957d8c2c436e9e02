#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "downwash/base/key_error.hpp"
#include "downwash/effects/measurements.hpp"
#include "downwash/effects/wall_measurements.hpp"
#include "downwash/fitting/effect_comparison.hpp"

/// Whatever is read as measurements can be compared and fitted, or is an error. Measurements beside a wall have none
/// but numbers that their reader allows.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace downwash;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    try {
        for (const WallMeasurement& point : parse_wall_measurements(bytes, "walls.csv").points) {
            if (!(point.distance_over_r >= 1 && std::abs(point.force_over_thrust) <= 10)) {
                std::abort();
            }
        }
        return 0;
    } catch (const InputError&) {
    }
    try {
        const Measurements measurements = parse_measurements(bytes, "data.csv");
        for (const DataSetComparison& set : compare_effects({measurements})) {
            for (const ModelScore& score : set.scores) {
                if (!(score.rmse >= 0)) {
                    std::abort();
                }
            }
        }
    } catch (const InputError&) {
        return 0;
    }
    return 0;
}
