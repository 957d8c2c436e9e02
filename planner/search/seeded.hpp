#pragma once

#include <ompl/base/PlannerStatus.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>

#include <cstdint>
#include <memory>

namespace downwash::planning {

/// An OMPL planner whose random numbers come from a seed of its own, not from OMPL's global one.
template <class Planner>
class Seeded : public Planner {
 public:
    template <class Information>
    Seeded(const Information& information, std::uint32_t seed) : Planner(information) {
        this->rng_.setLocalSeed(seed);
    }

    /// Nodes in its tree or both of its trees; 0 before the first iteration.
    [[nodiscard]] std::size_t nodes() const {
        if constexpr (requires { this->tStart_; }) {
            return this->tStart_->size() + this->tGoal_->size();
        } else {
            return this->nn_ ? this->nn_->size() : 0;
        }
    }
};

/// Gives a planner its problem, and an exact neighbour search that draws no random numbers.
template <class Planner, class Definition>
std::shared_ptr<Planner> with_linear_neighbours(std::shared_ptr<Planner> planner, const Definition& definition) {
    planner->setProblemDefinition(definition);  // some planners need the objective during set-up
    planner->template setNearestNeighbors<ompl::NearestNeighborsLinear>();
    return planner;
}

}  // namespace downwash::planning
