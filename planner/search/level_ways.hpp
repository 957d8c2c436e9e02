#pragma once

#include <cstdint>
#include <vector>

#include "downwash/base/stop_condition.hpp"
#include "downwash/search/random.hpp"
#include "downwash/search/search_task.hpp"

namespace downwash::planning {

/// Finds ways of the level vehicle from the start to the goal, by OMPL's RRT-Connect (Kuffner and LaValle 2000):
/// straight lines from corner to corner on which nothing comes nearer to an obstacle than the safety margin. A tree of
/// flights that has to come through something narrow grows along them.
template <class Family>
class LevelWaysOf {
 public:
    using Configuration = typename Family::Configuration;

    /// @param task must outlive it
    explicit LevelWaysOf(const SearchTaskOf<Family>& task) : task_(task) {}

    /// The corners of a way, from the first one after the start to one in the goal region, of which none can be left
    /// out; nothing where none is found with `max_iterations` of RRT-Connect or before `is_over`.
    [[nodiscard]] std::vector<Configuration> find(Random& random, std::uint64_t max_iterations,
                                                  const StopCondition& is_over) const;

 private:
    const SearchTaskOf<Family>& task_;
};

}  // namespace downwash::planning
