#include "downwash/rivals/flight_space.hpp"

#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/control/StatePropagator.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>

#include <cstring>
#include <limits>

#include "downwash/base/lane_math.hpp"

namespace downwash::planning {
namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;

class Moment : public ob::State {
 public:
    FlightPoint point;
};

/// Samples moments of rest with the caller's generator.
class Sampler : public ob::StateSampler {
 public:
    Sampler(const ob::StateSpace* states, const SteeredFlights& flights, Random& random)
        : ob::StateSampler(states), flights_(flights), random_(random) {}

    void sampleUniform(ob::State* state) override {
        point_of(state) = flights_.resting_at(flights_.space().sample(random_));
    }
    void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
        point_of(state) = flights_.resting_at(flights_.space().sample_near(point_of(near).rest, distance, random_));
    }
    void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
        sampleUniformNear(state, mean, 2 * deviation);
    }

 private:
    const SteeredFlights& flights_;
    Random& random_;
};

/// (x, z, arm) of the place of rest, the arm as a length.
class PlaceOfRest : public ob::ProjectionEvaluator {
 public:
    PlaceOfRest(const ob::StateSpace* states, const SearchSpace& space)
        : ob::ProjectionEvaluator(states), search_(space) {}

    unsigned int getDimension() const override { return 3; }
    void defaultCellSizes() override {
        constexpr double cell_m = 1.0;
        cellSizes_ = {cell_m, cell_m, cell_m};
    }
    void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override {
        const Configuration& rest = point_of(state).rest;
        projection[0] = rest.x_m;
        projection[1] = rest.z_m;
        projection[2] =
            search_.arm_weight_m() * (search_.arm_is_limited() ? rest.arm_rad : lane::wrap_angle(rest.arm_rad));
    }

 private:
    const SearchSpace& search_;
};

class FlightSpace : public ob::StateSpace {
 public:
    FlightSpace(const SteeredFlights& flights, Random& random) : flights_(flights), random_(random) {
        setName("Flights");
        type_ = ob::STATE_SPACE_UNKNOWN;
    }

    unsigned int getDimension() const override { return 3; }
    double getMaximumExtent() const override { return space().extent_m(); }
    double getMeasure() const override {
        const Bounds& b = space().bounds();
        return (b.x_high_m - b.x_low_m) * (b.z_high_m - b.z_low_m) * space().arm_weight_m() *
               (space().arm_high_rad() - space().arm_low_rad());
    }
    /// Not one: moments of rest at the same place differ in cost and time. OMPL then searches neighbours in a way that
    /// draws no random numbers.
    bool isMetricSpace() const override { return false; }
    bool hasSymmetricInterpolate() const override { return false; }
    void enforceBounds(ob::State*) const override {}  // samples keep them, and a flight cannot be moved
    /// Of the reference; a start in motion may come to rest outside.
    bool satisfiesBounds(const ob::State* state) const override {
        const double* at = point_of(state).reference.position;
        return space().is_inside({at[0], at[1], at[2]});
    }
    void copyState(ob::State* to, const ob::State* from) const override { point_of(to) = point_of(from); }
    double distance(const ob::State* a, const ob::State* b) const override {
        return space().distance_m(point_of(a).rest, point_of(b).rest);
    }
    bool equalStates(const ob::State* a, const ob::State* b) const override {
        return is_same_moment(point_of(a), point_of(b));
    }
    /// Between two moments there is only flight; planners over controls do not ask.
    void interpolate(const ob::State* from, const ob::State* to, double s, ob::State* state) const override {
        point_of(state) = s < 0.5 ? point_of(from) : point_of(to);
    }
    ob::StateSamplerPtr allocDefaultStateSampler() const override {
        return std::make_shared<Sampler>(this, flights_, random_);
    }
    ob::State* allocState() const override { return new Moment; }
    void freeState(ob::State* state) const override { delete static_cast<Moment*>(state); }
    void registerProjections() override { registerDefaultProjection(std::make_shared<PlaceOfRest>(this, space())); }

 private:
    [[nodiscard]] const SearchSpace& space() const noexcept { return flights_.space(); }

    const SteeredFlights& flights_;
    Random& random_;
};

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

class Validity : public ob::StateValidityChecker {
 public:
    using ob::StateValidityChecker::StateValidityChecker;
    bool isValid(const ob::State* state) const override { return point_of(state).is_valid; }
};

class FlightGoal : public ob::GoalSampleableRegion {
 public:
    FlightGoal(const ob::SpaceInformationPtr& information, const SteeredFlights& flights, Random& random)
        : ob::GoalSampleableRegion(information), flights_(flights), random_(random) {}

    double distanceGoal(const ob::State* state) const override {
        return flights_.space().goal_distance_m(point_of(state).rest);
    }
    bool isSatisfied(const ob::State* state) const override {
        const FlightPoint& point = point_of(state);
        return flights_.is_worth_closing(point) && flights_.closing(point).has_value();
    }
    bool isSatisfied(const ob::State* state, double* distance) const override {
        if (distance != nullptr) {
            *distance = distanceGoal(state);
        }
        return isSatisfied(state);
    }
    void sampleGoal(ob::State* state) const override {
        const std::optional<Configuration> sample = flights_.space().sample_goal(random_);
        point_of(state) = flights_.resting_at(sample ? *sample : flights_.space().sample(random_));
    }
    unsigned int maxSampleCount() const override { return std::numeric_limits<unsigned int>::max(); }

 private:
    const SteeredFlights& flights_;
    Random& random_;
};

class FlightObjective : public ob::OptimizationObjective {
 public:
    explicit FlightObjective(const ob::SpaceInformationPtr& information) : ob::OptimizationObjective(information) {
        // SST ends with any solution, and is sent on to the next better one.
        setCostThreshold(infiniteCost());
    }
    ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
    ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
        return ob::Cost(point_of(to).cost - point_of(from).cost);
    }
    bool isSymmetric() const override { return false; }
};

}  // namespace

bool is_same_moment(const FlightPoint& a, const FlightPoint& b) {
    return std::memcmp(&a.vehicle, &b.vehicle, sizeof(FlightState)) == 0 && a.reference == b.reference;
}

FlightPoint& point_of(ob::State* state) {
    return static_cast<Moment*>(state)->point;
}

const FlightPoint& point_of(const ob::State* state) {
    return static_cast<const Moment*>(state)->point;
}

const double* velocity_of(const oc::Control* control) {
    return control->as<oc::RealVectorControlSpace::ControlType>()->values;
}

oc::SpaceInformationPtr make_flight_information(const SteeredFlights& flights, Random& random) {
    const auto states = std::make_shared<FlightSpace>(flights, random);
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
    information->setStateValidityChecker(std::make_shared<Validity>(information));
    information->setPropagationStepSize(flights.steps().duration_s());
    information->setMinMaxControlDuration(1, most_control_steps);
    information->setup();
    return information;
}

ob::GoalPtr make_flight_goal(const oc::SpaceInformationPtr& information, const SteeredFlights& flights,
                             Random& random) {
    return std::make_shared<FlightGoal>(information, flights, random);
}

ob::OptimizationObjectivePtr make_flight_objective(const oc::SpaceInformationPtr& information) {
    return std::make_shared<FlightObjective>(information);
}

}  // namespace downwash::planning
