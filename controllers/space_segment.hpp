#pragma once

#include <cstdint>

#include "downwash/base/export.hpp"
#include "downwash/controllers/space_reference.hpp"

namespace downwash {

/// One piece of a reference in space: per axis the quintic Hermite polynomial between two points, a whole number of
/// control ticks long. Between two points at rest it is the straight line, all axes together.
class DOWNWASH_EXPORT SpaceSegment {
 public:
    /// @param ticks length in control ticks, >= 1   @param tick_s length of a tick [s], > 0
    SpaceSegment(const SpacePoint& from, const SpacePoint& to, std::int64_t ticks, double tick_s) noexcept;

    [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }
    [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
    [[nodiscard]] const SpacePoint& from() const noexcept { return from_; }
    [[nodiscard]] const SpacePoint& to() const noexcept { return to_; }

    /// The reference at the beginning of tick `tick`, 0 <= tick <= ticks(); exactly `from` and `to` at the ends.
    [[nodiscard]] SpacePoint at_tick(std::int64_t tick) const noexcept;
    /// The reference at a share s of the duration, in [0, 1].
    [[nodiscard]] SpacePoint at(double s) const noexcept;

    /// The coefficients of the powers of the time over the duration, per axis; see quintic_at().
    [[nodiscard]] const double (&coefficients() const noexcept)[space_axes<max_joints>][6] { return coefficient_; }
    [[nodiscard]] double inverse_duration_1_s() const noexcept { return inverse_duration_1_s_; }

 private:
    SpacePoint from_;
    SpacePoint to_;
    std::int64_t ticks_;
    double tick_s_;
    double duration_s_;
    double inverse_duration_1_s_;
    double coefficient_[space_axes<max_joints>][6];  // of the powers of t / duration, per axis
};

}  // namespace downwash
