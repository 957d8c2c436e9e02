#pragma once

#include "downwash/base/lane_math.hpp"

// Four doubles side by side, for the kernels that fly several edges at once. Written in the vector extensions of GCC and
// Clang: the compiler makes of it whatever the translation unit is allowed, AVX2, pairs of SSE2 or NEON, or four plain
// doubles, and every lane gives the same bits as a plain double (without contraction). Everything here has internal
// linkage, so that code for wide instructions never leaks out of the translation unit that was compiled for them.

namespace downwash::lane {
inline namespace {  // NOLINT(google-build-namespaces): internal linkage is the point

constexpr int pack_width = 4;

/// One truth value per lane: all bits set or none.
struct PackMask {
    long long bits __attribute__((vector_size(32)));
};

struct Pack {
    typedef double Doubles __attribute__((vector_size(32)));  // NOLINT(modernize-use-using): using ignores the attribute
    Doubles values;

    Pack() = default;
    explicit Pack(double all) : values{all, all, all, all} {}
    explicit Pack(Doubles doubles) : values(doubles) {}
    double operator[](int lane) const { return values[lane]; }
    void set(int lane, double value) { values[lane] = value; }

    static Pack load(const double* from) { return Pack(Doubles{from[0], from[1], from[2], from[3]}); }
    void store(double* to) const {
        for (int lane = 0; lane < pack_width; ++lane) {
            to[lane] = values[lane];
        }
    }

    friend Pack operator+(Pack a, Pack b) { return Pack(a.values + b.values); }
    friend Pack operator-(Pack a, Pack b) { return Pack(a.values - b.values); }
    friend Pack operator*(Pack a, Pack b) { return Pack(a.values * b.values); }
    friend Pack operator/(Pack a, Pack b) { return Pack(a.values / b.values); }
    friend Pack operator-(Pack a) { return Pack(-a.values); }
    friend PackMask operator<(Pack a, Pack b) { return {a.values < b.values}; }
    friend PackMask operator>(Pack a, Pack b) { return {a.values > b.values}; }
    friend PackMask operator<=(Pack a, Pack b) { return {a.values <= b.values}; }
    friend PackMask operator>=(Pack a, Pack b) { return {a.values >= b.values}; }
};

inline PackMask operator&(PackMask a, PackMask b) {
    return {a.bits & b.bits};
}
inline PackMask operator|(PackMask a, PackMask b) {
    return {a.bits | b.bits};
}
inline Pack select(PackMask condition, Pack yes, Pack no) {
    return Pack(condition.bits ? yes.values : no.values);
}
inline Pack sqrt(Pack x) {
    return Pack(Pack::Doubles{__builtin_sqrt(x[0]), __builtin_sqrt(x[1]), __builtin_sqrt(x[2]), __builtin_sqrt(x[3])});
}
inline bool any(PackMask mask) {
    return (mask.bits[0] | mask.bits[1] | mask.bits[2] | mask.bits[3]) != 0;
}

}  // namespace
}  // namespace downwash::lane
