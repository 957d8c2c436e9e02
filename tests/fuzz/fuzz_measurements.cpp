#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "downwash/base/key_error.hpp"
#include "downwash/effects/measurements.hpp"
#include "downwash/fitting/effect_comparison.hpp"

/// Whatever is read as measurements can be compared and fitted, or is an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace downwash;
    try {
        const Measurements measurements = parse_measurements({reinterpret_cast<const char*>(data), size}, "data.csv");
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
