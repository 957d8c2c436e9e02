#include "downwash/search/flight_space.hpp"

#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>

#include <cstring>
#include <limits>
#include <ostream>
#include <span>
#include <type_traits>
#include <utility>

#include "downwash/base/lane_math.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/search/ompl_space.hpp"

namespace downwash::planning {
namespace {

namespace ob = ompl::base;

template <class Family>
class Moment : public ob::State {
 public:
    FlightPointOf<Family> point;
};

/// Samples moments of rest at places that the sampler of the space of configurations draws.
template <class Family>
class FlightSampler : public ob::StateSampler {
 public:
    using SearchTask = SearchTaskOf<Family>;

    FlightSampler(const ob::StateSpace* states, const ob::StateSpacePtr& places, const SearchTask& task)
        : ob::StateSampler(states),
          task_(task),
          place_(places),
          beside_(places),
          places_(places->allocStateSampler()) {}

    void sampleUniform(ob::State* state) override {
        places_->sampleUniform(place_.get());
        rest_at_place(state);
    }
    void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
        write(point_of<Family>(near).rest, beside_.get(), task_.space);
        places_->sampleUniformNear(place_.get(), beside_.get(), distance);
        rest_at_place(state);
    }
    void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
        write(point_of<Family>(mean).rest, beside_.get(), task_.space);
        places_->sampleGaussian(place_.get(), beside_.get(), deviation);
        rest_at_place(state);
    }

 private:
    void rest_at_place(ob::State* state) {
        point_of<Family>(state) = resting_at(task_.model, read(place_.get(), task_.space));
    }

    const SearchTask& task_;
    ob::ScopedState<> place_, beside_;
    ob::StateSamplerPtr places_;
};

/// The coordinates of the place of rest, angles as lengths.
template <class Family>
class PlaceOfRest : public ob::ProjectionEvaluator {
 public:
    using SearchSpace = typename Family::SearchSpace;

    PlaceOfRest(const ob::StateSpace* states, const SearchSpace& space)
        : ob::ProjectionEvaluator(states), search_(space) {}

    unsigned int getDimension() const override { return static_cast<unsigned int>(search_.axes().size()); }
    void defaultCellSizes() override {
        constexpr double cell_m = 1.0;
        cellSizes_.assign(search_.axes().size(), cell_m);
    }
    void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override {
        const auto& rest = point_of<Family>(state).rest;
        for (std::size_t i = 0; i < search_.axes().size(); ++i) {
            const SearchAxis& axis = search_.axes()[i];
            projection[static_cast<Eigen::Index>(i)] =
                axis.weight_m * (axis.wraps ? lane::wrap_angle(rest[i]) : rest[i]);
        }
    }

 private:
    const SearchSpace& search_;
};

template <class Family>
class FlightSpace : public ob::StateSpace {
 public:
    using SearchTask = SearchTaskOf<Family>;
    using SearchSpace = typename Family::SearchSpace;

    FlightSpace(const SearchTask& task, Random& random)
        : task_(task), random_(random), places_(make_configuration_space(task.space, random)) {
        setName("Flights");
        type_ = ob::STATE_SPACE_UNKNOWN;
    }

    [[nodiscard]] Random& random() const noexcept { return random_; }
    [[nodiscard]] const ob::StateSpacePtr& places() const noexcept { return places_; }

    void setup() override {
        places_->setup();
        ob::StateSpace::setup();
    }
    unsigned int getDimension() const override { return places_->getDimension(); }
    double getMaximumExtent() const override { return places_->getMaximumExtent(); }
    double getMeasure() const override { return places_->getMeasure(); }
    /// Not one: moments of rest at the same place differ in cost and time. OMPL then searches neighbours in a way that
    /// draws no random numbers.
    bool isMetricSpace() const override { return false; }
    bool hasSymmetricInterpolate() const override { return false; }
    void enforceBounds(ob::State*) const override {}  // samples keep them, and a flight cannot be moved
    /// Whether the reference is inside; a start in motion may come to rest outside.
    bool satisfiesBounds(const ob::State* state) const override {
        return space().is_inside(configuration_of(point_of<Family>(state).reference));
    }
    void copyState(ob::State* to, const ob::State* from) const override {
        point_of<Family>(to) = point_of<Family>(from);
    }
    double distance(const ob::State* a, const ob::State* b) const override {
        return space().distance_m(point_of<Family>(a).rest, point_of<Family>(b).rest);
    }
    bool equalStates(const ob::State* a, const ob::State* b) const override {
        return is_same_moment(point_of<Family>(a), point_of<Family>(b));
    }
    /// Between two moments there is only flight: the nearer one stands for it.
    void interpolate(const ob::State* from, const ob::State* to, double s, ob::State* state) const override {
        point_of<Family>(state) = s < 0.5 ? point_of<Family>(from) : point_of<Family>(to);
    }
    ob::StateSamplerPtr allocDefaultStateSampler() const override {
        return std::make_shared<FlightSampler<Family>>(this, places_, task_);
    }
    ob::State* allocState() const override { return new Moment<Family>; }
    void freeState(ob::State* state) const override { delete static_cast<Moment<Family>*>(state); }
    void registerProjections() override {
        registerDefaultProjection(std::make_shared<PlaceOfRest<Family>>(this, space()));
    }

 protected:
    [[nodiscard]] const SearchSpace& space() const noexcept { return task_.space; }

    const SearchTask& task_;

 private:
    Random& random_;
    ob::StateSpacePtr places_;
};

/// The space of flights in the plane, whose moments can be written as bytes.
class PlanarFlightSpace : public FlightSpace<Plane> {
 public:
    using FlightSpace::FlightSpace;

    unsigned int getSerializationLength() const override {
        std::size_t numbers = number_count_in(task_.model.nominal_world());
        for (std::size_t i = 0; i < other_worlds(); ++i) {
            numbers += number_count_in(task_.worlds->worlds[i]);
        }
        return static_cast<unsigned int>(sizeof(PlainMoment) + numbers * sizeof(double));
    }
    void serialize(void* bytes, const ob::State* state) const override {
        const FlightPoint& point = point_of(state);
        const PlainMoment plain{point.reference, point.rest, point.cost, point.ticks, point.is_valid};
        auto* to = static_cast<char*>(bytes);
        std::memcpy(to, &plain, sizeof plain);
        to = write_vehicle(point.vehicle, task_.model.nominal_world(), to + sizeof plain);
        for (std::size_t i = 0; i < other_worlds(); ++i) {
            to = write_vehicle(i < point.others.size() ? point.others[i] : point.vehicle, task_.worlds->worlds[i], to);
        }
    }
    void deserialize(ob::State* state, const void* bytes) const override {
        static_assert(std::is_trivially_copyable_v<PlainMoment>);
        PlainMoment plain;
        const auto* from = static_cast<const char*>(bytes);
        std::memcpy(&plain, from, sizeof plain);
        from += sizeof plain;
        FlightPoint& point = point_of(state);
        from = read_vehicle(from, task_.model.nominal_world(), point.vehicle);
        point.others.resize(other_worlds());
        for (std::size_t i = 0; i < other_worlds(); ++i) {
            from = read_vehicle(from, task_.worlds->worlds[i], point.others[i]);
        }
        point.reference = plain.reference;
        point.rest = plain.rest;
        point.cost = plain.cost;
        point.ticks = plain.ticks;
        point.is_valid = plain.is_valid;
    }
    void printState(const ob::State* state, std::ostream& out) const override {
        const Configuration at = configuration_of(point_of(state).vehicle.plant.q);
        out << "vehicle at";
        const std::span<const Axis> axes = task_.problem.axes();
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            out << ' ' << axes[axis].position << ' ' << at[axis];
        }
        out << '\n';
    }

 private:
    /// A moment but for the vehicle.
    struct PlainMoment {
        ReferencePoint reference;
        Configuration rest;
        double cost;
        std::int64_t ticks;
        bool is_valid;
    };

    /// How many numbers the state of a vehicle has in a world.
    [[nodiscard]] static std::size_t number_count_in(const FlownWorld& world) {
        return simulation::state_numbers + simulation::older_ticks(world.numbers.delay_ticks) *
                                               number_count<double, simulation::PastMotion<double>>;
    }
    /// @return the end of what was written
    static char* write_vehicle(const FlightState& vehicle, const FlownWorld& world, char* to) {
        FlightState whole = vehicle;
        simulation::remember_older(world.numbers, whole.world);
        for (std::size_t i = 0; i < number_count_in(world); ++i, to += sizeof(double)) {
            const double number = simulation::number_of(whole, static_cast<int>(i));
            std::memcpy(to, &number, sizeof number);
        }
        return to;
    }
    /// @return the end of what was read
    static const char* read_vehicle(const char* from, const FlownWorld& world, FlightState& vehicle) {
        vehicle.world.older.resize(simulation::older_ticks(world.numbers.delay_ticks));
        for (std::size_t i = 0; i < number_count_in(world); ++i, from += sizeof(double)) {
            double number = 0;
            std::memcpy(&number, from, sizeof number);
            simulation::set_number_of(vehicle, static_cast<int>(i), number);
        }
        return from;
    }

    [[nodiscard]] std::size_t other_worlds() const noexcept {
        return task_.worlds != nullptr ? task_.worlds->worlds.size() : 0;
    }
};

template <class Family>
class FlightValidity : public ob::StateValidityChecker {
 public:
    using ob::StateValidityChecker::StateValidityChecker;
    bool isValid(const ob::State* state) const override { return point_of<Family>(state).is_valid; }
};

template <class Family>
class FlightObjective : public ob::OptimizationObjective {
 public:
    explicit FlightObjective(const ob::SpaceInformationPtr& information) : ob::OptimizationObjective(information) {
        // SST ends with any solution, and is sent on to the next better one.
        setCostThreshold(infiniteCost());
    }
    ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
    ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
        return ob::Cost(point_of<Family>(to).cost - point_of<Family>(from).cost);
    }
    bool isSymmetric() const override { return false; }
};

}  // namespace

template <class Family>
FlightPointOf<Family>& point_of(ob::State* state) {
    return static_cast<Moment<Family>*>(state)->point;
}

template <class Family>
const FlightPointOf<Family>& point_of(const ob::State* state) {
    return static_cast<const Moment<Family>*>(state)->point;
}

template <>
ob::StateSpacePtr make_flight_space(const SearchTask& task, Random& random) {
    return std::make_shared<PlanarFlightSpace>(task, random);
}
template <>
ob::StateSpacePtr make_flight_space(const SearchTaskOf<Space>& task, Random& random) {
    return std::make_shared<FlightSpace<Space>>(task, random);
}

Random& random_of(const ob::StateSpace& flights) {
    return static_cast<const FlightSpace<Plane>&>(flights).random();
}

const ob::StateSpacePtr& places_of(const ob::StateSpace& flights) {
    return static_cast<const FlightSpace<Plane>&>(flights).places();
}

template <class Family>
ob::StateValidityCheckerPtr make_flight_validity(const ob::SpaceInformationPtr& information) {
    return std::make_shared<FlightValidity<Family>>(information);
}

template <class Family>
ob::OptimizationObjectivePtr make_flight_objective(const ob::SpaceInformationPtr& information) {
    return std::make_shared<FlightObjective<Family>>(information);
}

bool is_flight_objective(const ob::OptimizationObjective& objective) {
    return dynamic_cast<const FlightObjective<Plane>*>(&objective) != nullptr;
}

template <class Family>
FlightGoalOf<Family>::FlightGoalOf(const ob::SpaceInformationPtr& information, const SearchTask& task, Random& random)
    : ob::GoalSampleableRegion(information), task_(task), random_(random) {}

template <class Family>
double FlightGoalOf<Family>::distanceGoal(const ob::State* state) const {
    return task_.space.goal_distance_m(point_of<Family>(state).rest);
}

template <class Family>
bool FlightGoalOf<Family>::isSatisfied(const ob::State* state) const {
    const FlightPointOf<Family>& point = point_of<Family>(state);
    return is_at_rest(point.reference) && task_.space.is_near_goal(configuration_of(point.reference));
}

template <class Family>
bool FlightGoalOf<Family>::isSatisfied(const ob::State* state, double* distance) const {
    if (distance != nullptr) {
        *distance = distanceGoal(state);
    }
    return isSatisfied(state);
}

template <class Family>
void FlightGoalOf<Family>::sampleGoal(ob::State* state) const {
    const auto sample = task_.space.sample_goal(random_);
    point_of<Family>(state) = resting_at(task_.model, sample ? *sample : task_.space.sample(random_));
}

template <class Family>
unsigned int FlightGoalOf<Family>::maxSampleCount() const {
    return std::numeric_limits<unsigned int>::max();
}

template class FlightGoalOf<Plane>;
template class FlightGoalOf<Space>;
template FlightPoint& point_of<Plane>(ob::State*);
template const FlightPoint& point_of<Plane>(const ob::State*);
template FlightPointOf<Space>& point_of<Space>(ob::State*);
template const FlightPointOf<Space>& point_of<Space>(const ob::State*);
template ob::StateValidityCheckerPtr make_flight_validity<Plane>(const ob::SpaceInformationPtr&);
template ob::StateValidityCheckerPtr make_flight_validity<Space>(const ob::SpaceInformationPtr&);
template ob::OptimizationObjectivePtr make_flight_objective<Plane>(const ob::SpaceInformationPtr&);
template ob::OptimizationObjectivePtr make_flight_objective<Space>(const ob::SpaceInformationPtr&);

OmplTask::OmplTask(const SearchTask& task, Random& random)
    : information(std::make_shared<ob::SpaceInformation>(make_flight_space(task, random))),
      definition(std::make_shared<ob::ProblemDefinition>(information)) {
    information->setStateValidityChecker(make_flight_validity(information));
    information->setup();
    ob::ScopedState<> start(information);
    point_of(start.get()) = start_point(task);
    definition->addStartState(start);
    definition->setGoal(std::make_shared<FlightGoal>(information, task, random));
    definition->setOptimizationObjective(make_flight_objective(information));
}

}  // namespace downwash::planning
