#pragma once

#include <ompl/base/Goal.h>
#include <ompl/base/SpaceInformation.h>

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>

#include "downwash/search/query_counts.hpp"
#include "downwash/search/random.hpp"

// The search space, of either family, as OMPL sees it. Every random number comes from the caller's generator, none from
// OMPL's global one.

namespace downwash::planning {

/// The configurations of a problem as a space of OMPL: the translations, then each joint, a circle or an interval where
/// it has limits, with bounds and weights. Distances, interpolation and samples are those of SearchSpace. The arguments
/// must outlive it.
template <class SearchSpace>
[[nodiscard]] ompl::base::StateSpacePtr make_configuration_space(const SearchSpace& space, Random& random);

/// That space with validity and straight-line motions of the level vehicle. The arguments must outlive it.
template <class SearchSpace>
[[nodiscard]] ompl::base::SpaceInformationPtr make_space_information(const SearchSpace& space, Random& random,
                                                                     double motion_step_m, QueryCounts& counts);

/// The goal region: any level configuration that meets the goal, sampled by inverse kinematics.
/// @param max_samples that planners draw which collect goals before they search
template <class SearchSpace>
[[nodiscard]] ompl::base::GoalPtr make_goal_region(const ompl::base::SpaceInformationPtr& information,
                                                   const SearchSpace& space, Random& random,
                                                   unsigned int max_samples = std::numeric_limits<unsigned int>::max());

/// Copies a configuration into a state of that space.
template <class SearchSpace>
void write(const typename SearchSpace::Configuration& configuration, ompl::base::State* state,
           const SearchSpace& space);

/// The configuration of a state.
template <class SearchSpace>
[[nodiscard]] typename SearchSpace::Configuration read(const ompl::base::State* state, const SearchSpace& space);

}  // namespace downwash::planning
