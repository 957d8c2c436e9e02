#pragma once

#if defined(__AVX512F__) || defined(__AVX2__) || defined(__SSE2__)
#include <immintrin.h>
#endif

#include "downwash/base/lane_math.hpp"

// Several doubles side by side, for the kernels that fly several edges at once: eight in a register of AVX-512, four in
// one of AVX2, else four in a pair of registers (SSE2, NEON). Written in the vector extensions of GCC and Clang, with
// intrinsics for what compilers do not find by themselves; every lane gives the same bits as a plain double (without
// contraction). Everything here has internal linkage, so that code for wide instructions never leaks out of the
// translation unit that was compiled for them.

namespace downwash::lane {
inline namespace {  // NOLINT(google-build-namespaces): internal linkage is the point

#if defined(__AVX512F__)
inline constexpr int register_width = 8;
inline constexpr int pack_registers = 1;
#elif defined(__AVX2__)
inline constexpr int register_width = 4;
inline constexpr int pack_registers = 1;
#else
inline constexpr int register_width = 2;
inline constexpr int pack_registers = 2;
#endif
inline constexpr int pack_width = register_width * pack_registers;

/// One register. Not `using`, which ignores the attribute.
typedef double Doubles __attribute__((vector_size(8 * register_width)));  // NOLINT(modernize-use-using)
using DoublesBits = decltype(Doubles{} < Doubles{});

/// One truth value per lane of a register: a bit, or all bits of the lane.
#if defined(__AVX512F__)
using Mask = __mmask8;
#else
using Mask = DoublesBits;
#endif

inline Mask less(Doubles a, Doubles b) {
#if defined(__AVX512F__)
    return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ);
#else
    return a < b;
#endif
}
inline Mask less_or_equal(Doubles a, Doubles b) {
#if defined(__AVX512F__)
    return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
#else
    return a <= b;
#endif
}
/// The lanes in which it holds, as bits.
inline unsigned int bits_of(Mask mask) {
#if defined(__AVX512F__)
    return mask;
#elif defined(__AVX2__)
    return static_cast<unsigned int>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
#elif defined(__SSE2__)
    return static_cast<unsigned int>(_mm_movemask_pd(reinterpret_cast<__m128d>(mask)));
#else
    return (mask[0] != 0 ? 1U : 0U) | (mask[1] != 0 ? 2U : 0U);
#endif
}
inline Doubles select(Mask mask, Doubles yes, Doubles no) {
#if defined(__AVX512F__)
    return _mm512_mask_blend_pd(mask, no, yes);
#elif defined(__AVX2__)
    return _mm256_blendv_pd(no, yes, reinterpret_cast<__m256d>(mask));
#else
    return reinterpret_cast<Doubles>((reinterpret_cast<DoublesBits>(yes) & mask) |
                                     (reinterpret_cast<DoublesBits>(no) & ~mask));
#endif
}
inline Doubles sqrt(Doubles x) {
#if defined(__AVX512F__)
    return _mm512_sqrt_pd(x);
#elif defined(__AVX2__)
    return _mm256_sqrt_pd(x);
#elif defined(__SSE2__)
    return _mm_sqrt_pd(x);
#else
    return Doubles{__builtin_sqrt(x[0]), __builtin_sqrt(x[1])};
#endif
}
// min and max of equal numbers, and of NaN, are those of lane_math.hpp: hence the order of the operands.
inline Doubles min(Doubles a, Doubles b) {
#if defined(__AVX512F__)
    return _mm512_min_pd(b, a);
#elif defined(__AVX2__)
    return _mm256_min_pd(b, a);
#elif defined(__SSE2__)
    return _mm_min_pd(b, a);
#else
    return select(less(b, a), b, a);
#endif
}
inline Doubles max(Doubles a, Doubles b) {
#if defined(__AVX512F__)
    return _mm512_max_pd(b, a);
#elif defined(__AVX2__)
    return _mm256_max_pd(b, a);
#elif defined(__SSE2__)
    return _mm_max_pd(b, a);
#else
    return select(less(a, b), b, a);
#endif
}
inline Doubles abs(Doubles x) {
    constexpr long long all_but_sign = ~(1ULL << 63U);
    return reinterpret_cast<Doubles>(reinterpret_cast<DoublesBits>(x) & (all_but_sign - DoublesBits{}));
}

struct Pack {
    Doubles part[pack_registers];

    Pack() = default;
    explicit Pack(double all) {
        for (Doubles& doubles : part) {
            doubles = all - Doubles{};  // not +, which would lose the sign of -0
        }
    }
    void store(double* to) const { __builtin_memcpy(to, this, sizeof *this); }
};

inline double number_in(const Pack& pack, int lane) {
    return pack.part[lane / register_width][lane % register_width];
}
inline void set_number(Pack& pack, int lane, double number) {
    pack.part[lane / register_width][lane % register_width] = number;
}

/// One truth value per lane.
struct PackMask {
    Mask part[pack_registers];
};

/// A pack or a mask, its registers given by `of(number)`.
template <class Result, class Of>
[[gnu::always_inline]] inline Result by_register(const Of& of) {
    Result result;
    for (int i = 0; i < pack_registers; ++i) {
        result.part[i] = of(i);
    }
    return result;
}

inline Pack operator+(Pack a, Pack b) {
    return by_register<Pack>([&](int i) { return a.part[i] + b.part[i]; });
}
inline Pack operator-(Pack a, Pack b) {
    return by_register<Pack>([&](int i) { return a.part[i] - b.part[i]; });
}
inline Pack operator*(Pack a, Pack b) {
    return by_register<Pack>([&](int i) { return a.part[i] * b.part[i]; });
}
inline Pack operator/(Pack a, Pack b) {
    return by_register<Pack>([&](int i) { return a.part[i] / b.part[i]; });
}
inline Pack operator-(Pack a) {
    return by_register<Pack>([&](int i) { return -a.part[i]; });
}
inline PackMask operator<(Pack a, Pack b) {
    return by_register<PackMask>([&](int i) { return less(a.part[i], b.part[i]); });
}
inline PackMask operator<=(Pack a, Pack b) {
    return by_register<PackMask>([&](int i) { return less_or_equal(a.part[i], b.part[i]); });
}
inline PackMask operator>(Pack a, Pack b) {
    return b < a;
}
inline PackMask operator>=(Pack a, Pack b) {
    return b <= a;
}
inline PackMask operator&(PackMask a, PackMask b) {
    return by_register<PackMask>([&](int i) { return static_cast<Mask>(a.part[i] & b.part[i]); });
}
inline PackMask operator|(PackMask a, PackMask b) {
    return by_register<PackMask>([&](int i) { return static_cast<Mask>(a.part[i] | b.part[i]); });
}
inline PackMask operator!(PackMask a) {
    return by_register<PackMask>([&](int i) { return static_cast<Mask>(~a.part[i]); });
}

/// The lanes in which the condition holds, as bits; the first lane is the lowest.
inline unsigned int bits_of(PackMask mask) {
    unsigned int bits = 0;
    for (int i = 0; i < pack_registers; ++i) {
        bits |= bits_of(mask.part[i]) << static_cast<unsigned int>(i * register_width);
    }
    return bits;
}
inline bool any(PackMask mask) {
    return bits_of(mask) != 0;
}
inline Pack select(PackMask condition, Pack yes, Pack no) {
    return by_register<Pack>([&](int i) { return select(condition.part[i], yes.part[i], no.part[i]); });
}
inline Pack sqrt(Pack x) {
    return by_register<Pack>([&](int i) { return sqrt(x.part[i]); });
}
inline Pack min(Pack a, Pack b) {
    return by_register<Pack>([&](int i) { return min(a.part[i], b.part[i]); });
}
inline Pack max(Pack a, Pack b) {
    return by_register<Pack>([&](int i) { return max(a.part[i], b.part[i]); });
}
inline Pack abs(Pack x) {
    return by_register<Pack>([&](int i) { return abs(x.part[i]); });
}

}  // namespace
}  // namespace downwash::lane
