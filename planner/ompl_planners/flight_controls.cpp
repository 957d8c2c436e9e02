#include "downwash/ompl_planners/flight_controls.hpp"

#include <ompl/control/StatePropagator.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

namespace downwash::planning {
namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;

/// A reference velocity or, for our own planner, a reference segment.
class FlightControl : public oc::RealVectorControlSpace::ControlType {
 public:
    FlightControl() { values = velocity; }

    double velocity[max_axes]{};     ///< where OMPL's `values` point
    std::int64_t segment_ticks = 0;  ///< 0: a velocity
    ReferencePoint segment_end;
};

class FlightControlSpace : public oc::RealVectorControlSpace {
 public:
    using oc::RealVectorControlSpace::RealVectorControlSpace;

    oc::Control* allocControl() const override { return new FlightControl; }
    void freeControl(oc::Control* control) const override { delete static_cast<FlightControl*>(control); }
    void copyControl(oc::Control* to, const oc::Control* from) const override {
        oc::RealVectorControlSpace::copyControl(to, from);
        static_cast<FlightControl*>(to)->segment_ticks = static_cast<const FlightControl*>(from)->segment_ticks;
        static_cast<FlightControl*>(to)->segment_end = static_cast<const FlightControl*>(from)->segment_end;
    }
    bool equalControls(const oc::Control* a, const oc::Control* b) const override {
        const auto* first = static_cast<const FlightControl*>(a);
        const auto* second = static_cast<const FlightControl*>(b);
        return oc::RealVectorControlSpace::equalControls(a, b) && first->segment_ticks == second->segment_ticks &&
               first->segment_end == second->segment_end;
    }
    void nullControl(oc::Control* control) const override {
        oc::RealVectorControlSpace::nullControl(control);
        static_cast<FlightControl*>(control)->segment_ticks = 0;
    }
};

/// Velocities in all directions alike, and durations, with the caller's generator.
class VelocitySampler : public oc::ControlSampler {
 public:
    VelocitySampler(const oc::ControlSpace* controls, std::span<const Axis> axes, const MotionLimits& limits,
                    Random& random)
        : oc::ControlSampler(controls), axes_(axes), limits_(limits), random_(random) {}

    void sample(oc::Control* control) override {
        auto* own = static_cast<FlightControl*>(control);
        own->segment_ticks = 0;
        double squares = 0;
        do {
            squares = 0;
            for (std::size_t i = 0; i < axes_.size(); ++i) {
                if (axes_[i].group == AxisGroup::translation) {
                    own->velocity[i] = random_.uniform(-1, 1);
                    squares += own->velocity[i] * own->velocity[i];
                }
            }
        } while (squares > 1);
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            const double most = max_rate(limits_, axes_[i].group);
            if (axes_[i].group == AxisGroup::translation) {
                own->velocity[i] *= most;
            } else {
                own->velocity[i] = random_.uniform(-most, most);
            }
        }
    }
    unsigned int sampleStepCount(unsigned int least, unsigned int most) override {
        return static_cast<unsigned int>(random_.uniform(least, most + 1.0));
    }

 private:
    std::span<const Axis> axes_;
    MotionLimits limits_;
    Random& random_;
};

class Propagator : public oc::StatePropagator {
 public:
    Propagator(const oc::SpaceInformationPtr& information, const SteeredFlights& flights)
        : oc::StatePropagator(information), flights_(flights) {}

    /// OMPL propagates one step at a time.
    void propagate(const ob::State* from, const oc::Control* control, double, ob::State* to) const override {
        const auto* own = static_cast<const FlightControl*>(control);
        point_of(to) = own->segment_ticks > 0 ? flights_.followed(point_of(from), own->segment_end, own->segment_ticks)
                                              : flights_.stepped(point_of(from), velocity_of(control));
    }
    bool canPropagateBackward() const override { return false; }

 private:
    const SteeredFlights& flights_;
};

/// Satisfied where a flight to rest at the goal, and the hover there, break no rule.
class ClosingGoal : public FlightGoal {
 public:
    ClosingGoal(const ob::SpaceInformationPtr& information, const SteeredFlights& flights, Random& random)
        : FlightGoal(information, flights.task(), random), flights_(flights) {}

    using FlightGoal::isSatisfied;
    bool isSatisfied(const ob::State* state) const override {
        const FlightPoint& point = point_of(state);
        return flights_.is_worth_closing(point) && flights_.closing(point).has_value();
    }

 private:
    const SteeredFlights& flights_;
};

}  // namespace

void follow(oc::Control* control, const ReferencePoint& to, std::int64_t ticks) {
    auto* own = static_cast<FlightControl*>(control);
    std::ranges::fill(own->velocity, 0.0);
    own->segment_end = to;
    own->segment_ticks = ticks;
}

const double* velocity_of(const oc::Control* control) {
    return control->as<oc::RealVectorControlSpace::ControlType>()->values;
}

oc::SpaceInformationPtr make_flight_information(const SteeredFlights& flights, Random& random) {
    const auto states = make_flight_space(flights.task(), random);
    const std::span<const Axis> axes = flights.task().problem.axes();
    const auto count = static_cast<unsigned int>(axes.size());
    const auto controls = std::make_shared<FlightControlSpace>(states, count);
    const MotionLimits& limits = flights.flights().limits();
    ob::RealVectorBounds bounds(count);
    for (unsigned int i = 0; i < count; ++i) {
        const double most = max_rate(limits, axes[i].group);
        bounds.setLow(i, -most);
        bounds.setHigh(i, most);
    }
    controls->setBounds(bounds);
    controls->setControlSamplerAllocator(
        [axes, &limits, &random](const oc::ControlSpace* space) -> oc::ControlSamplerPtr {
            return std::make_shared<VelocitySampler>(space, axes, limits, random);
        });
    auto information = std::make_shared<oc::SpaceInformation>(states, controls);
    information->setStatePropagator(std::make_shared<Propagator>(information, flights));
    information->setStateValidityChecker(make_flight_validity(information));
    information->setPropagationStepSize(flights.steps().duration_s());
    information->setMinMaxControlDuration(1, max_control_steps);
    information->setup();
    return information;
}

ob::GoalPtr make_closing_goal(const oc::SpaceInformationPtr& information, const SteeredFlights& flights,
                              Random& random) {
    return std::make_shared<ClosingGoal>(information, flights, random);
}

std::vector<FlightPoint> moments_along(const oc::PathControl& path, const SteeredFlights& flights) {
    std::vector<FlightPoint> moments{point_of(path.getState(0))};
    for (std::size_t i = 0; i < path.getControlCount(); ++i) {
        const auto number = static_cast<unsigned int>(i);
        const auto* control = static_cast<const FlightControl*>(path.getControl(number));
        if (control->segment_ticks > 0) {
            moments.push_back(flights.followed(moments.back(), control->segment_end, control->segment_ticks));
        }
        const auto steps = control->segment_ticks > 0
                               ? 0
                               : std::llround(path.getControlDuration(number) / flights.steps().duration_s());
        for (long long step = 0; step < steps; ++step) {
            moments.push_back(flights.stepped_again(moments.back(), velocity_of(path.getControl(number))));
        }
        if (!is_same_moment(point_of(path.getState(number + 1)), moments.back())) {
            throw std::logic_error("flying a path again did not reproduce it bit for bit");
        }
    }
    return moments;
}

}  // namespace downwash::planning
