#include "downwash/simulation/instructions.hpp"

#include <cstddef>

namespace downwash {

std::span<const Instructions> known_instructions() noexcept {
    static constexpr Instructions all[] = {Instructions::baseline, Instructions::avx2, Instructions::avx512};
    std::size_t known = 1;
#ifdef DOWNWASH_HAS_AVX2_KERNEL
    known += __builtin_cpu_supports("avx2") != 0 ? 1 : 0;
#endif
#ifdef DOWNWASH_HAS_AVX512_KERNEL
    known += known == 2 && __builtin_cpu_supports("avx512f") != 0 ? 1 : 0;
#endif
    return {all, known};
}

}  // namespace downwash
