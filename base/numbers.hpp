#pragma once

#include <type_traits>

#include "downwash/base/lane_math.hpp"

// Structs that consist of nothing but numbers of one type T, in the order of their declaration: what is loaded, stored,
// copied or differentiated number by number needs no list of members.

namespace downwash {

/// How many numbers of type T a Struct consists of.
template <class T, class Struct>
inline constexpr int number_count = [] {
    static_assert(std::is_trivially_copyable_v<Struct> && sizeof(Struct) % sizeof(T) == 0);
    return static_cast<int>(sizeof(Struct) / sizeof(T));
}();

/// One number of a struct.
template <class T, class Struct>
[[nodiscard, gnu::always_inline]] inline T number_at(const Struct& from, int i) {
    T number;
    __builtin_memcpy(&number, reinterpret_cast<const unsigned char*>(&from) + static_cast<unsigned>(i) * sizeof(T),
                     sizeof(T));
    return number;
}

/// Replaces one number of a struct.
template <class T, class Struct>
[[gnu::always_inline]] inline void set_number_at(Struct& to, int i, const T& number) {
    __builtin_memcpy(reinterpret_cast<unsigned char*>(&to) + static_cast<unsigned>(i) * sizeof(T), &number, sizeof(T));
}

/// Whether all numbers of a struct are at most so large in size; none of them is NaN then.
template <class Struct>
[[nodiscard]] inline bool are_within(const Struct& numbers, double max) noexcept {
    bool all = true;
    for (int i = 0; i < number_count<double, Struct>; ++i) {
        const double number = number_at<double>(numbers, i);
        all = all && number <= max && number >= -max;
    }
    return all;
}

/// Number by number those of `yes` where a condition holds, those of `no` elsewhere.
/// @param condition of the lane type that lane::select() takes for T
template <class T, template <class> class Struct, class Condition>
[[nodiscard, gnu::always_inline]] inline Struct<T> select_each(const Condition& condition, const Struct<T>& yes,
                                                               const Struct<T>& no) {
    Struct<T> result;
    for (int i = 0; i < number_count<T, Struct<T>>; ++i) {
        set_number_at(result, i, lane::select(condition, number_at<T>(yes, i), number_at<T>(no, i)));
    }
    return result;
}

}  // namespace downwash
