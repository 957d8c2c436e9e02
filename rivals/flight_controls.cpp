#include "downwash/rivals/flight_controls.hpp"

#include <ompl/control/StatePropagator.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>

namespace downwash::planning {
namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;

/// Velocities in all directions alike, and durations, with the caller's generator.
class VelocitySampler : public oc::ControlSampler {
 public:
    VelocitySampler(const oc::ControlSpace* controls, const ReferenceLimits& limits, Random& random)
        : oc::ControlSampler(controls), limits_(limits), random_(random) {}

    void sample(oc::Control* control) override {
        double* velocity = control->as<oc::RealVectorControlSpace::ControlType>()->values;
        do {
            velocity[0] = random_.uniform(-1, 1);
            velocity[1] = random_.uniform(-1, 1);
        } while (velocity[0] * velocity[0] + velocity[1] * velocity[1] > 1);
        velocity[0] *= limits_.max_speed_m_s;
        velocity[1] *= limits_.max_speed_m_s;
        velocity[2] = random_.uniform(-limits_.max_arm_rate_rad_s, limits_.max_arm_rate_rad_s);
    }
    unsigned int sampleStepCount(unsigned int least, unsigned int most) override {
        return static_cast<unsigned int>(random_.uniform(least, most + 1.0));
    }

 private:
    ReferenceLimits limits_;
    Random& random_;
};

class Propagator : public oc::StatePropagator {
 public:
    Propagator(const oc::SpaceInformationPtr& information, const SteeredFlights& flights)
        : oc::StatePropagator(information), flights_(flights) {}

    /// OMPL propagates one step at a time.
    void propagate(const ob::State* from, const oc::Control* control, double, ob::State* to) const override {
        point_of(to) = flights_.stepped(point_of(from), velocity_of(control));
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

const double* velocity_of(const oc::Control* control) {
    return control->as<oc::RealVectorControlSpace::ControlType>()->values;
}

oc::SpaceInformationPtr make_flight_information(const SteeredFlights& flights, Random& random) {
    const auto states = make_flight_space(flights.task(), random);
    const auto controls = std::make_shared<oc::RealVectorControlSpace>(states, 3);
    const ReferenceLimits& limits = flights.flights().limits();
    ob::RealVectorBounds bounds(3);
    const double most[3] = {limits.max_speed_m_s, limits.max_speed_m_s, limits.max_arm_rate_rad_s};
    for (unsigned int i = 0; i < 3; ++i) {
        bounds.setLow(i, -most[i]);
        bounds.setHigh(i, most[i]);
    }
    controls->setBounds(bounds);
    controls->setControlSamplerAllocator([&limits, &random](const oc::ControlSpace* space) -> oc::ControlSamplerPtr {
        return std::make_shared<VelocitySampler>(space, limits, random);
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

}  // namespace downwash::planning
