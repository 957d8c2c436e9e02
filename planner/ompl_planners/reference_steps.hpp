#pragma once

#include <cstdint>
#include <vector>

#include "downwash/search/search_space.hpp"

namespace downwash::planning {

/// A reference that is steered by velocities, in steps of equal length: what a planner over controls decides at each
/// step. Within a step the reference runs on the quintic between its ends, both without acceleration, so that the steps
/// of a flight are the segments of a Plan, to the last bit.
template <class Family>
class ReferenceStepsOf {
 public:
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using MotionLimits = typename Family::MotionLimits;

    /// @param axes with a group each
    /// @param tick_s length of a control tick; a step is the whole number of them nearest to half a second, at least
    /// one
    template <class Axes>
    ReferenceStepsOf(const Axes& axes, const MotionLimits& limits, double tick_s) : ReferenceStepsOf(limits, tick_s) {
        for (const auto& axis : axes) {
            add(axis.group);
        }
    }

    [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }
    [[nodiscard]] double duration_s() const noexcept { return duration_s_; }

    /// The reference one step later. It takes on the wanted velocity as far as the limits allow: the speed never
    /// exceeds its limit, nor the acceleration, whose peak in the middle of the step is 3/2 of its mean.
    /// @param from without acceleration   @param velocity wanted along each axis [m/s or rad/s], finite
    [[nodiscard]] ReferencePoint after(const ReferencePoint& from, const double* velocity) const noexcept;

    /// Where the reference comes to rest when it is asked to stand still from now on.
    [[nodiscard]] Configuration rest_of(const ReferencePoint& from) const noexcept;

    /// How long that takes [ticks]: a whole number of steps, as many as weak limits ask for.
    [[nodiscard]] double braking_ticks(const ReferencePoint& from) const noexcept;

 private:
    ReferenceStepsOf(const MotionLimits& limits, double tick_s);
    void add(AxisGroup group);

    /// An axis, and what it may do in a step.
    struct StepAxis {
        AxisGroup group;
        double max_rate;  ///< of translations that of all together
        double gain;      ///< greatest change of the rate
    };
    [[nodiscard]] double speed_of(const double* rates) const noexcept;
    void shorten(double* rates, double StepAxis::*limit) const noexcept;

    std::vector<StepAxis> axes_;
    MotionLimits limits_;
    std::int64_t ticks_;
    double duration_s_;
};
using ReferenceSteps = ReferenceStepsOf<Plane>;

}  // namespace downwash::planning
