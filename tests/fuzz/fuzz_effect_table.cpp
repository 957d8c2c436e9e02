#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "downwash/base/key_error.hpp"
#include "downwash/effects/effect_table.hpp"

/// Whatever is read as a table gives factors within its range at every distance.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace downwash;
    std::shared_ptr<const EffectTable> table;
    try {
        table = parse_effect_table({reinterpret_cast<const char*>(data), size}, "table.csv");
    } catch (const InputError&) {
        return 0;
    }
    for (double d_over_r = 0; d_over_r < 20; d_over_r = 2 * d_over_r + 0.3) {
        const EffectTable::Curve curve = table->at(d_over_r);
        for (double z_over_r = 0; z_over_r < 2000; z_over_r = 1.3 * z_over_r + 0.01) {
            const double change = std::abs(curve(z_over_r) - 1);
            if (!(change <= table->largest_change_beyond(z_over_r) * (1 + 1e-9) + 1e-15)) {
                std::abort();
            }
        }
    }
    return 0;
}
