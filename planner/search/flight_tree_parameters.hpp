#pragma once

#include <span>
#include <string_view>

#include "downwash/problems/algorithms.hpp"

namespace downwash::planning {

/// The numbers that RRT* of flights works with. What each means, its default and its range stand in algorithms(), under
/// the same name.
struct FlightTreeParameters {
    double first_goal_bias, goal_bias, local_bias, local_radius_m, passage_share, way_share;
    double range_share, optimism, max_detour, alternative_distance_m;
    double worthwhile_gain, final_gain;
    double batch_size, first_batch_size;
    double round_work, max_round_work, execution_tick_work, sample_work, usual_sample_work, refine_work;
    double max_rejected_at_end;

    /// Those of a problem.
    explicit FlightTreeParameters(const PlannerSettings& settings);

    /// One of them by its name.
    struct Member {
        std::string_view name;
        double FlightTreeParameters::*value;
    };
    /// Each once.
    [[nodiscard]] static std::span<const Member> members() noexcept;
    /// Default, range and meaning of one of them. @pre there is one of that name
    [[nodiscard]] static const AlgorithmParameter& info(std::string_view name);
};

}  // namespace downwash::planning
