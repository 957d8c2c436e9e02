#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "../grids/grids.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/grids/factor_grid_file.hpp"

/// Whatever is read as a grid can be written and read again, the same to the bit.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace downwash;
    std::optional<FactorGrid> grid;
    try {
        grid = parse_factor_grid({reinterpret_cast<const char*>(data), size}, "grid.csv");
    } catch (const InputError&) {
        return 0;
    }
    if (!test::is_same(parse_factor_grid(grid_csv_text(*grid), "again.csv"), *grid)) {
        std::abort();
    }
    return 0;
}
