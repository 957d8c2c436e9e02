#pragma once

#include <cstdint>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"

// The reference at a tick. Private: not installed.

namespace downwash::judge {

/// A coordinate with its first and second time derivatives.
struct Course {
    double position = 0, velocity = 0, acceleration = 0;
};

/// The quintic from one course to another, by the Hermite basis of degree five.
/// @param s in [0, 1], of the duration
[[nodiscard]] Course between(const Course& from, const Course& to, double duration_s, double s);

/// Reference along the knots of a plan: between two of them the quintic of each axis that has the position, velocity
/// and acceleration of both (quintic Hermite interpolation); behind the last one the last.
/// @pre ticks of the knots rise from 0
class Reference {
 public:
    DOWNWASH_EXPORT explicit Reference(const Plan& plan) : plan_(plan) {}

    /// At a control tick, which may only rise from call to call.
    [[nodiscard]] DOWNWASH_EXPORT ReferencePoint at(std::int64_t tick);

 private:
    const Plan& plan_;
    std::size_t piece_ = 0;  ///< its first knot
};

}  // namespace downwash::judge
