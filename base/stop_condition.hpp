#pragma once

#include <exception>
#include <functional>

namespace downwash {

/// Whether long work has to end now. Asked at least every 0.1 s, from all threads that share the work. Empty: never.
using StopCondition = std::function<bool()>;

/// Work has ended before its result was whole.
class WorkStopped : public std::exception {
 public:
    [[nodiscard]] const char* what() const noexcept override { return "the work was stopped before it was done"; }
};

/// @throws WorkStopped if the work has to end
inline void throw_if_over(const StopCondition& is_over) {
    if (is_over && is_over()) {
        throw WorkStopped();
    }
}

}  // namespace downwash
