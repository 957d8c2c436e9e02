#pragma once

#include <cmath>
#include <cstdint>

// A lane type that counts. Include it before the templates that are to be counted: their calls of lane::sqrt() and the
// like only find what is declared before them.

namespace downwash::lane {

/// Operations on numbers so far. What is known before a flight, and integers, are not among them.
struct Operations {
    std::int64_t sums = 0;       ///< additions and subtractions
    std::int64_t products = 0;   ///< multiplications
    std::int64_t quotients = 0;  ///< divisions and square roots
    std::int64_t others = 0;     ///< comparisons, choices, minima and maxima

    [[nodiscard]] std::int64_t arithmetic() const noexcept { return sums + products + quotients; }
};
inline Operations operations;

/// A double whose operations are counted.
struct Counted {
    double value;

    Counted() = default;
    explicit Counted(double of) : value(of) {}
};

inline Counted operator+(Counted a, Counted b) {
    ++operations.sums;
    return Counted(a.value + b.value);
}
inline Counted operator-(Counted a, Counted b) {
    ++operations.sums;
    return Counted(a.value - b.value);
}
inline Counted operator*(Counted a, Counted b) {
    ++operations.products;
    return Counted(a.value * b.value);
}
inline Counted operator/(Counted a, Counted b) {
    ++operations.quotients;
    return Counted(a.value / b.value);
}
inline Counted operator-(Counted a) {
    return Counted(-a.value);
}
inline bool operator<(Counted a, Counted b) {
    ++operations.others;
    return a.value < b.value;
}
inline bool operator<=(Counted a, Counted b) {
    ++operations.others;
    return a.value <= b.value;
}
inline bool operator>(Counted a, Counted b) {
    return b < a;
}
inline bool operator>=(Counted a, Counted b) {
    return b <= a;
}
inline Counted select(bool condition, Counted yes, Counted no) {
    ++operations.others;
    return condition ? yes : no;
}
inline Counted sqrt(Counted x) {
    ++operations.quotients;
    return Counted(std::sqrt(x.value));
}
inline Counted abs(Counted x) {
    return Counted(std::fabs(x.value));
}
inline Counted min(Counted a, Counted b) {
    ++operations.others;
    return b.value < a.value ? b : a;
}
inline Counted max(Counted a, Counted b) {
    ++operations.others;
    return a.value < b.value ? b : a;
}
inline double number_in(Counted x, int /*lane*/) {
    return x.value;
}
inline void set_number(Counted& x, int /*lane*/, double number) {
    x = Counted(number);
}

}  // namespace downwash::lane
