#include "downwash/ompl_planners/flight_controls.hpp"

#include <ompl/control/StatePropagator.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <stdexcept>

namespace downwash::planning {
namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;

/// A reference velocity or, for our own planner, a reference segment.
template <class Family>
class FlightControl : public oc::RealVectorControlSpace::ControlType {
 public:
    using ReferencePoint = typename Family::ReferencePoint;

    FlightControl() { values = velocity; }

    double velocity[std::size(ReferencePoint{}.velocity)]{};  ///< where OMPL's `values` point
    std::int64_t segment_ticks = 0;                           ///< 0: a velocity
    ReferencePoint segment_end;
};

template <class Family>
class FlightControlSpace : public oc::RealVectorControlSpace {
 public:
    using oc::RealVectorControlSpace::RealVectorControlSpace;

    oc::Control* allocControl() const override { return new FlightControl<Family>; }
    void freeControl(oc::Control* control) const override { delete static_cast<FlightControl<Family>*>(control); }
    void copyControl(oc::Control* to, const oc::Control* from) const override {
        oc::RealVectorControlSpace::copyControl(to, from);
        static_cast<FlightControl<Family>*>(to)->segment_ticks =
            static_cast<const FlightControl<Family>*>(from)->segment_ticks;
        static_cast<FlightControl<Family>*>(to)->segment_end =
            static_cast<const FlightControl<Family>*>(from)->segment_end;
    }
    bool equalControls(const oc::Control* a, const oc::Control* b) const override {
        const auto* first = static_cast<const FlightControl<Family>*>(a);
        const auto* second = static_cast<const FlightControl<Family>*>(b);
        return oc::RealVectorControlSpace::equalControls(a, b) && first->segment_ticks == second->segment_ticks &&
               first->segment_end == second->segment_end;
    }
    void nullControl(oc::Control* control) const override {
        oc::RealVectorControlSpace::nullControl(control);
        static_cast<FlightControl<Family>*>(control)->segment_ticks = 0;
    }
};

/// Velocities in all directions alike, and durations, with the caller's generator.
template <class Family>
class VelocitySampler : public oc::ControlSampler {
 public:
    VelocitySampler(const oc::ControlSpace* controls, std::span<const SearchAxis> axes, Random& random)
        : oc::ControlSampler(controls), axes_(axes), random_(random) {}

    void sample(oc::Control* control) override {
        auto* own = static_cast<FlightControl<Family>*>(control);
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
            const double most = axes_[i].max_rate;
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
    std::span<const SearchAxis> axes_;
    Random& random_;
};

template <class Family>
class Propagator : public oc::StatePropagator {
 public:
    using SteeredFlights = SteeredFlightsOf<Family>;

    Propagator(const oc::SpaceInformationPtr& information, const SteeredFlights& flights)
        : oc::StatePropagator(information), flights_(flights) {}

    /// OMPL propagates one step at a time.
    void propagate(const ob::State* from, const oc::Control* control, double, ob::State* to) const override {
        const auto* own = static_cast<const FlightControl<Family>*>(control);
        point_of<Family>(to) = own->segment_ticks > 0
                                   ? flights_.followed(point_of<Family>(from), own->segment_end, own->segment_ticks)
                                   : flights_.stepped(point_of<Family>(from), velocity_of(control));
    }
    bool canPropagateBackward() const override { return false; }

 private:
    const SteeredFlights& flights_;
};

/// Satisfied where a flight to rest at the goal, and the hover there, break no rule.
template <class Family>
class ClosingGoal : public FlightGoalOf<Family> {
 public:
    using SteeredFlights = SteeredFlightsOf<Family>;

    ClosingGoal(const ob::SpaceInformationPtr& information, const SteeredFlights& flights, Random& random)
        : FlightGoalOf<Family>(information, flights.task(), random), flights_(flights) {}

    using FlightGoalOf<Family>::isSatisfied;
    bool isSatisfied(const ob::State* state) const override {
        const FlightPointOf<Family>& point = point_of<Family>(state);
        return flights_.is_worth_closing(point) && flights_.closing(point).has_value();
    }

 private:
    const SteeredFlights& flights_;
};

}  // namespace

void follow(oc::Control* control, const ReferencePoint& to, std::int64_t ticks) {
    auto* own = static_cast<FlightControl<Plane>*>(control);
    std::ranges::fill(own->velocity, 0.0);
    own->segment_end = to;
    own->segment_ticks = ticks;
}

const double* velocity_of(const oc::Control* control) {
    return control->as<oc::RealVectorControlSpace::ControlType>()->values;
}

template <class Family>
oc::SpaceInformationPtr make_flight_information(const SteeredFlightsOf<Family>& flights, Random& random) {
    const auto states = make_flight_space(flights.task(), random);
    const std::span<const SearchAxis> axes = flights.space().axes();
    const auto count = static_cast<unsigned int>(axes.size());
    const auto controls = std::make_shared<FlightControlSpace<Family>>(states, count);
    ob::RealVectorBounds bounds(count);
    for (unsigned int i = 0; i < count; ++i) {
        const double most = axes[i].max_rate;
        bounds.setLow(i, -most);
        bounds.setHigh(i, most);
    }
    controls->setBounds(bounds);
    controls->setControlSamplerAllocator([axes, &random](const oc::ControlSpace* space) -> oc::ControlSamplerPtr {
        return std::make_shared<VelocitySampler<Family>>(space, axes, random);
    });
    auto information = std::make_shared<oc::SpaceInformation>(states, controls);
    information->setStatePropagator(std::make_shared<Propagator<Family>>(information, flights));
    information->setStateValidityChecker(make_flight_validity<Family>(information));
    information->setPropagationStepSize(flights.steps().duration_s());
    information->setMinMaxControlDuration(1, max_control_steps);
    information->setup();
    return information;
}

template <class Family>
ob::GoalPtr make_closing_goal(const oc::SpaceInformationPtr& information, const SteeredFlightsOf<Family>& flights,
                              Random& random) {
    return std::make_shared<ClosingGoal<Family>>(information, flights, random);
}

template <class Family>
std::vector<FlightPointOf<Family>> moments_along(const oc::PathControl& path, const SteeredFlightsOf<Family>& flights) {
    std::vector<FlightPointOf<Family>> moments{point_of<Family>(path.getState(0))};
    for (std::size_t i = 0; i < path.getControlCount(); ++i) {
        const auto number = static_cast<unsigned int>(i);
        const auto* control = static_cast<const FlightControl<Family>*>(path.getControl(number));
        if (control->segment_ticks > 0) {
            moments.push_back(flights.followed(moments.back(), control->segment_end, control->segment_ticks));
        }
        const auto steps = control->segment_ticks > 0
                               ? 0
                               : std::llround(path.getControlDuration(number) / flights.steps().duration_s());
        for (long long step = 0; step < steps; ++step) {
            moments.push_back(flights.stepped_again(moments.back(), velocity_of(path.getControl(number))));
        }
        if (!is_same_moment(point_of<Family>(path.getState(number + 1)), moments.back())) {
            throw std::logic_error("flying a path again did not reproduce it bit for bit");
        }
    }
    return moments;
}

template oc::SpaceInformationPtr make_flight_information(const SteeredFlights&, Random&);
template oc::SpaceInformationPtr make_flight_information(const SteeredFlightsOf<Space>&, Random&);
template ob::GoalPtr make_closing_goal(const oc::SpaceInformationPtr&, const SteeredFlights&, Random&);
template ob::GoalPtr make_closing_goal(const oc::SpaceInformationPtr&, const SteeredFlightsOf<Space>&, Random&);
template std::vector<FlightPoint> moments_along(const oc::PathControl&, const SteeredFlights&);
template std::vector<FlightPointOf<Space>> moments_along(const oc::PathControl&, const SteeredFlightsOf<Space>&);

}  // namespace downwash::planning
