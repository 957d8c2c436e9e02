#pragma once

#include <algorithm>
#include <string_view>
#include <variant>

#include "downwash/base/numbers.hpp"
#include "downwash/controllers/aided_law.hpp"
#include "downwash/controllers/cascaded_pid.hpp"
#include "downwash/controllers/model_inversion.hpp"
#include "downwash/controllers/planar_lyapunov.hpp"

// The control laws that a robot can be flown by. docs/extending/controller.md says what a law consists of.

namespace downwash {

/// A law that flights are compiled for, with its gains.
using FlownLaw = std::variant<ModelInversion, CascadedPid>;

/// One of the laws that a robot file can choose. The first is that of a file without `controller.type`.
using ControlLaw = std::variant<ModelInversion, CascadedPid, PlanarLyapunov>;

/// The controller of a robot.
struct Controller {
    double rate_hz = 100;  ///< control ticks per second; a command is held over one tick
    double delay_s = 0;    ///< age of the state that the law sees, at most 64 ticks; linear between ticks
    ControlLaw law;
};

namespace controllers {

/// A law that is a model inversion in other terms.
template <class Law>
concept InvertedLaw = requires(const Law& law) {
    { law.inverted() } -> std::convertible_to<FlownLaw>;
};

/// The law that flights are compiled for: the law itself, or the model inversion that it is in other terms.
[[nodiscard]] inline FlownLaw flown_law(const ControlLaw& law) {
    return std::visit(
        []<class Law>(const Law& own) -> FlownLaw {
            if constexpr (InvertedLaw<Law>) {
                return own.inverted();
            } else {
                return own;
            }
        },
        law);
}

/// Calls `fly` with the law itself, or with Aided if it has an observer or a feed-forward.
template <class Fly>
decltype(auto) visit_flown(const FlownLaw& law, const Fly& fly) {
    return std::visit(
        [&]<class Law>(const Law& own) {
            if constexpr (CanBeAided<Law>) {
                if (own.aids.are_any()) {
                    return fly(Aided<Law>{own});
                }
            }
            return fly(own);
        },
        law);
}

/// The observer and the feed-forward of a law.
/// @tparam Any FlownLaw or ControlLaw
template <class Any>
[[nodiscard]] Aids aids_of(const Any& law) {
    return std::visit(
        []<class Law>(const Law& own) {
            if constexpr (CanBeAided<Law>) {
                return own.aids;
            } else {
                return Aids{};
            }
        },
        law);
}

/// The numbers of the largest memory of a law.
template <class Law>
constexpr int max_memory_of() {
    if constexpr (CanBeAided<Law>) {
        return static_cast<int>(sizeof(typename Aided<Law>::template Memory<double>) / sizeof(double));
    } else {
        return static_cast<int>(sizeof(typename Law::template Memory<double>) / sizeof(double));
    }
}

/// The largest max_memory_of() among laws.
template <class... Laws>
constexpr int max_memory(const std::variant<Laws...>* /*laws*/) {
    return std::max({max_memory_of<Laws>()...});
}

/// What the law of a flight remembers, whichever it is: the numbers of its memory, then zeros.
template <class T>
struct LawMemory {
    T number[max_memory(static_cast<const FlownLaw*>(nullptr))];
};

/// How many numbers a law remembers, with its aids.
[[nodiscard]] inline int memory_size(const FlownLaw& law) {
    return visit_flown(law, []<class Flown>(const Flown& /*law*/) {
        return number_count<double, typename Flown::template Memory<double>>;
    });
}

/// Reads the memory of one law.
template <class Law, class T>
[[nodiscard, gnu::always_inline]] inline typename Law::template Memory<T> recalled(const LawMemory<T>& all) {
    using Memory = typename Law::template Memory<T>;
    Memory own;
    for (int i = 0; i < number_count<T, Memory>; ++i) {
        set_number_at(own, i, all.number[i]);
    }
    return own;
}

/// Writes the memory of one law, number by number in place: a copy of the whole costs some percent of a tick.
template <class T, template <class> class Memory>
[[gnu::always_inline]] inline void remember(const Memory<T>& memory, LawMemory<T>& all) {
    constexpr int own = number_count<T, Memory<T>>;
    for (int i = 0; i < own; ++i) {
        all.number[i] = number_at<T>(memory, i);
    }
    for (int i = own; i < number_count<T, LawMemory<T>>; ++i) {
        all.number[i] = T(0);
    }
}

/// The memory of one law as a LawMemory.
template <class T, template <class> class Memory>
[[nodiscard, gnu::always_inline]] inline LawMemory<T> remembered(const Memory<T>& memory) {
    LawMemory<T> all;
    remember(memory, all);
    return all;
}

}  // namespace controllers
}  // namespace downwash
