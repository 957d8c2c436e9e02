#include "downwash/search/ompl_space.hpp"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>

#include <algorithm>
#include <cmath>

#include "downwash/search/search_space.hpp"
#include "downwash/search/space_search_space.hpp"

namespace downwash::planning {
namespace {

namespace ob = ompl::base;
using RealVector = ob::RealVectorStateSpace::StateType;
using Turn = ob::SO2StateSpace::StateType;

/// The translations as one space, then one for each joint that moves: a circle, or an interval where it has limits.
/// Distances are those of SearchSpace, the root of weighted squares. An angle on a circle may be given in any turn.
template <class SearchSpace>
class ConfigurationSpace : public ob::CompoundStateSpace {
 public:
    using Configuration = typename SearchSpace::Configuration;

    explicit ConfigurationSpace(const SearchSpace& space) : search_(space) {
        const auto position = std::make_shared<ob::RealVectorStateSpace>();
        addSubspace(position, 1);
        for (const SearchAxis& axis : space.axes()) {
            if (axis.group == AxisGroup::translation) {
                position->addDimension(axis.low, axis.high);
            } else if (axis.wraps) {
                addSubspace(std::make_shared<ob::SO2StateSpace>(), axis.weight_m);
            } else if (!axis.is_fixed()) {
                const auto joint = std::make_shared<ob::RealVectorStateSpace>(1);
                joint->setBounds(axis.low, axis.high);
                addSubspace(joint, axis.weight_m);
            }
        }
        lock();
    }

    /// It is one, but if it said so OMPL would search neighbours with random numbers of its own seed.
    bool isMetricSpace() const override { return false; }
    double getMaximumExtent() const override { return search_.extent_m(); }
    double distance(const ob::State* a, const ob::State* b) const override {
        return search_.distance_m(read(a, search_), read(b, search_));
    }
    void interpolate(const ob::State* from, const ob::State* to, double s, ob::State* state) const override {
        const Configuration a = read(from, search_);
        write(between(a, search_.seen_from(a, read(to, search_)), s), state, search_);
    }
    bool satisfiesBounds(const ob::State* state) const override { return search_.is_inside(read(state, search_)); }

 private:
    const SearchSpace& search_;
};

/// Samples with the caller's generator.
template <class SearchSpace>
class Sampler : public ob::StateSampler {
 public:
    Sampler(const ob::StateSpace* states, const SearchSpace& space, Random& random)
        : ob::StateSampler(states), search_(space), random_(random) {}

    void sampleUniform(ob::State* state) override { write(search_.sample(random_), state, search_); }
    void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
        write(search_.sample_near(read(near, search_), distance, random_), state, search_);
    }
    void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
        // The sum of twelve uniform numbers is near enough to a normal one for a planner.
        const auto normal = [this] {
            double sum = -6;
            for (int i = 0; i < 12; ++i) {
                sum += random_.uniform(0, 1);
            }
            return sum;
        };
        auto c = read(mean, search_);
        for (std::size_t axis = 0; axis < search_.axes().size(); ++axis) {
            c[axis] += deviation * normal() / search_.axes()[axis].weight_m;
        }
        write(c, state, search_);
        space_->enforceBounds(state);
    }

 private:
    const SearchSpace& search_;
    Random& random_;
};

template <class SearchSpace>
class Validity : public ob::StateValidityChecker {
 public:
    Validity(const ob::SpaceInformationPtr& information, const SearchSpace& space, QueryCounts& counts)
        : ob::StateValidityChecker(information), space_(space), counts_(counts) {}

    bool isValid(const ob::State* state) const override { return space_.is_allowed(read(state, space_), counts_); }

 private:
    const SearchSpace& space_;
    QueryCounts& counts_;
};

/// Straight lines, checked so densely that no point of the robot moves farther than a step between two checks.
template <class SearchSpace>
class StraightMotion : public ob::MotionValidator {
 public:
    StraightMotion(const ob::SpaceInformationPtr& information, const SearchSpace& space, double step_m,
                   QueryCounts& counts)
        : ob::MotionValidator(information), space_(space), step_m_(step_m), counts_(counts) {}

    bool checkMotion(const ob::State* from, const ob::State* to) const override {
        std::pair<ob::State*, double> unused{nullptr, 0};
        return checkMotion(from, to, unused);
    }

    bool checkMotion(const ob::State* from, const ob::State* to,
                     std::pair<ob::State*, double>& last_valid) const override {
        const auto a = read(from, space_);
        const auto b = space_.seen_from(a, read(to, space_));
        double motion_m = space_.travel_m(a, b);
        for (std::size_t axis = 0; axis < space_.axes().size(); ++axis) {
            if (space_.axes()[axis].group != AxisGroup::translation) {
                motion_m += 2 * space_.axes()[axis].weight_m * std::abs(b[axis] - a[axis]);
            }
        }
        const int steps = static_cast<int>(std::ceil(motion_m / step_m_)) + 1;
        for (int i = 1; i <= steps; ++i) {
            const auto c = between(a, b, static_cast<double>(i) / steps);
            if (!space_.is_allowed(c, counts_)) {
                last_valid.second = static_cast<double>(i - 1) / steps;
                if (last_valid.first != nullptr) {
                    si_->getStateSpace()->interpolate(from, to, last_valid.second, last_valid.first);
                }
                return false;
            }
        }
        return true;
    }

 private:
    const SearchSpace& space_;
    double step_m_;
    QueryCounts& counts_;
};

template <class SearchSpace>
class SampledGoal : public ob::GoalSampleableRegion {
 public:
    SampledGoal(const ob::SpaceInformationPtr& information, const SearchSpace& space, Random& random,
                unsigned int max_samples)
        : ob::GoalSampleableRegion(information), space_(space), random_(random), max_samples_(max_samples) {
        setThreshold(1e-9);  // distanceGoal is 0 inside the region
    }

    double distanceGoal(const ob::State* state) const override { return space_.goal_distance_m(read(state, space_)); }

    /// Some planners take every valid sample for a goal, so it has to be one: where no new one is found, the last;
    /// before there is any, the middle of the region, which the planner may find invalid.
    void sampleGoal(ob::State* state) const override {
        if (const auto sample = space_.sample_goal(random_)) {
            last_ = *sample;
        }
        write(last_.value_or(space_.moved_into_goal(space_.sample(random_), 0)), state, space_);
    }

    unsigned int maxSampleCount() const override { return max_samples_; }

 private:
    const SearchSpace& space_;
    Random& random_;
    unsigned int max_samples_;
    mutable std::optional<typename SearchSpace::Configuration> last_;
};

}  // namespace

bool QueryCounts::note(Rejection rejection) noexcept {
    ++states;
    rejected_collision += rejection == Rejection::collision ? 1 : 0;
    rejected_bounds += rejection == Rejection::bounds ? 1 : 0;
    rejected_arm_limits += rejection == Rejection::arm_limits ? 1 : 0;
    return rejection == Rejection::none;
}

template <class SearchSpace>
void write(const typename SearchSpace::Configuration& c, ob::State* state, const SearchSpace& space) {
    auto* compound = state->as<ob::CompoundState>();
    unsigned int translation = 0, joint = 1;
    for (std::size_t i = 0; i < space.axes().size(); ++i) {
        const SearchAxis& axis = space.axes()[i];
        if (axis.group == AxisGroup::translation) {
            compound->as<RealVector>(0)->values[translation++] = c[i];
        } else if (axis.wraps) {
            compound->as<Turn>(joint++)->value = c[i];
        } else if (!axis.is_fixed()) {
            compound->as<RealVector>(joint++)->values[0] = c[i];
        }
    }
}

template <class SearchSpace>
typename SearchSpace::Configuration read(const ob::State* state, const SearchSpace& space) {
    const auto* compound = state->as<ob::CompoundState>();
    unsigned int translation = 0, joint = 1;
    typename SearchSpace::Configuration c{};
    for (std::size_t i = 0; i < space.axes().size(); ++i) {
        const SearchAxis& axis = space.axes()[i];
        if (axis.group == AxisGroup::translation) {
            c[i] = compound->as<RealVector>(0)->values[translation++];
        } else if (axis.wraps) {
            c[i] = compound->as<Turn>(joint++)->value;
        } else if (axis.is_fixed()) {
            c[i] = axis.low;
        } else {
            c[i] = compound->as<RealVector>(joint++)->values[0];
        }
    }
    return c;
}

template <class SearchSpace>
ob::StateSpacePtr make_configuration_space(const SearchSpace& space, Random& random) {
    const auto states = std::make_shared<ConfigurationSpace<SearchSpace>>(space);
    states->setStateSamplerAllocator([&space, &random](const ob::StateSpace* s) -> ob::StateSamplerPtr {
        return std::make_shared<Sampler<SearchSpace>>(s, space, random);
    });
    return states;
}

template <class SearchSpace>
ob::SpaceInformationPtr make_space_information(const SearchSpace& space, Random& random, double motion_step_m,
                                               QueryCounts& counts) {
    auto information = std::make_shared<ob::SpaceInformation>(make_configuration_space(space, random));
    information->setStateValidityChecker(std::make_shared<Validity<SearchSpace>>(information, space, counts));
    information->setMotionValidator(
        std::make_shared<StraightMotion<SearchSpace>>(information, space, motion_step_m, counts));
    information->setup();
    return information;
}

template <class SearchSpace>
ob::GoalPtr make_goal_region(const ob::SpaceInformationPtr& information, const SearchSpace& space, Random& random,
                             unsigned int max_samples) {
    return std::make_shared<SampledGoal<SearchSpace>>(information, space, random, max_samples);
}

template void write(const Configuration&, ob::State*, const SearchSpace&);
template Configuration read(const ob::State*, const SearchSpace&);
template ob::StateSpacePtr make_configuration_space(const SearchSpace&, Random&);
template ob::SpaceInformationPtr make_space_information(const SearchSpace&, Random&, double, QueryCounts&);
template ob::GoalPtr make_goal_region(const ob::SpaceInformationPtr&, const SearchSpace&, Random&, unsigned int);

template void write(const SpaceConfiguration&, ob::State*, const SpaceSearchSpace&);
template SpaceConfiguration read(const ob::State*, const SpaceSearchSpace&);
template ob::StateSpacePtr make_configuration_space(const SpaceSearchSpace&, Random&);
template ob::SpaceInformationPtr make_space_information(const SpaceSearchSpace&, Random&, double, QueryCounts&);
template ob::GoalPtr make_goal_region(const ob::SpaceInformationPtr&, const SpaceSearchSpace&, Random&, unsigned int);

}  // namespace downwash::planning
