#pragma once

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "downwash/base/lane_math.hpp"

// Four doubles side by side, for the kernels that fly several edges at once. Written in the vector extensions of GCC
// and Clang: the compiler makes of it whatever the translation unit is allowed, AVX2, pairs of SSE2 or NEON, or plain
// doubles, and every lane gives the same bits as a plain double (without contraction). Everything here has internal
// linkage, so that code for wide instructions never leaks out of the translation unit that was compiled for them.

namespace downwash::lane {
inline namespace {  // NOLINT(google-build-namespaces): internal linkage is the point

inline constexpr int pack_width = 4;

// Not `using`, which ignores the attribute.
typedef double Doubles __attribute__((vector_size(32)));  // NOLINT(modernize-use-using)
using DoublesMask = decltype(Doubles{} < Doubles{});

/// One truth value per lane: all bits set or none.
struct PackMask {
    DoublesMask bits;
    bool operator[](int lane) const { return bits[lane] != 0; }
};

struct Pack {
    Doubles values;

    Pack() = default;
    explicit Pack(double all) : values{all, all, all, all} {}
    explicit Pack(Doubles doubles) : values(doubles) {}
    double operator[](int lane) const { return values[lane]; }
    void set(int lane, double value) { values[lane] = value; }

    static Pack load(const double* from) {
        Pack pack;
        __builtin_memcpy(&pack, from, sizeof pack);
        return pack;
    }
    void store(double* to) const { __builtin_memcpy(to, this, sizeof *this); }
};

inline Pack operator+(Pack a, Pack b) {
    return Pack(a.values + b.values);
}
inline Pack operator-(Pack a, Pack b) {
    return Pack(a.values - b.values);
}
inline Pack operator*(Pack a, Pack b) {
    return Pack(a.values * b.values);
}
inline Pack operator/(Pack a, Pack b) {
    return Pack(a.values / b.values);
}
inline Pack operator-(Pack a) {
    return Pack(-a.values);
}
inline PackMask operator<(Pack a, Pack b) {
    return {a.values < b.values};
}
inline PackMask operator>(Pack a, Pack b) {
    return {a.values > b.values};
}
inline PackMask operator<=(Pack a, Pack b) {
    return {a.values <= b.values};
}
inline PackMask operator>=(Pack a, Pack b) {
    return {a.values >= b.values};
}
inline PackMask operator&(PackMask a, PackMask b) {
    return {a.bits & b.bits};
}
inline PackMask operator|(PackMask a, PackMask b) {
    return {a.bits | b.bits};
}

// What compilers do not find by themselves; the bits are those of the templates in lane_math.hpp.
inline bool any(PackMask mask) {
#ifdef __AVX2__
    return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask.bits)) != 0;
#else
    return (mask.bits[0] | mask.bits[1] | mask.bits[2] | mask.bits[3]) != 0;
#endif
}
inline bool all(PackMask mask) {
#ifdef __AVX2__
    return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask.bits)) == 15;
#else
    return (mask.bits[0] & mask.bits[1] & mask.bits[2] & mask.bits[3]) != 0;
#endif
}
inline Pack select(PackMask condition, Pack yes, Pack no) {
#ifdef __AVX2__
    return Pack(_mm256_blendv_pd(no.values, yes.values, reinterpret_cast<__m256d>(condition.bits)));
#else
    return Pack(reinterpret_cast<Doubles>((reinterpret_cast<DoublesMask>(yes.values) & condition.bits) |
                                          (reinterpret_cast<DoublesMask>(no.values) & ~condition.bits)));
#endif
}
inline Pack sqrt(Pack x) {
#ifdef __AVX2__
    return Pack(_mm256_sqrt_pd(x.values));
#else
    return Pack(Doubles{__builtin_sqrt(x[0]), __builtin_sqrt(x[1]), __builtin_sqrt(x[2]), __builtin_sqrt(x[3])});
#endif
}
inline Pack min(Pack a, Pack b) {
#ifdef __AVX2__
    return Pack(_mm256_min_pd(b.values, a.values));
#else
    return select(b < a, b, a);
#endif
}
inline Pack max(Pack a, Pack b) {
#ifdef __AVX2__
    return Pack(_mm256_max_pd(b.values, a.values));
#else
    return select(a < b, b, a);
#endif
}
inline Pack abs(Pack x) {
    constexpr long long sign = static_cast<long long>(1ULL << 63U);
    return Pack(
        reinterpret_cast<Doubles>(reinterpret_cast<DoublesMask>(x.values) & ~DoublesMask{sign, sign, sign, sign}));
}

}  // namespace
}  // namespace downwash::lane
