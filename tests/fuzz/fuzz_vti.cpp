#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "../aeromap/grids.hpp"
#include "downwash/aeromap/factor_grid_file.hpp"
#include "downwash/base/fault.hpp"

/// Whatever is read as a grid can be written and read again, the same to the bit.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace downwash;
    const std::string bytes = "<" + std::string(reinterpret_cast<const char*>(data), size);
    try {
        const FactorGrid grid = parse_factor_grid(bytes.substr(size > 0 && data[0] == '<' ? 1 : 0), "grid.vti");
        if (!test::is_same(parse_factor_grid(vti_text(grid), "again.vti"), grid)) {
            std::abort();
        }
    } catch (const InputError&) {
    }
    return 0;
}
