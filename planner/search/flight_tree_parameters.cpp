#include "downwash/search/flight_tree_parameters.hpp"

#include <array>

namespace downwash::planning {

FlightTreeParameters::FlightTreeParameters(const PlannerSettings& settings) {
    for (const Member& member : members()) {
        const auto own = settings.parameters.find(member.name);
        this->*member.value = own != settings.parameters.end() ? own->second : info(member.name).value;
    }
}

const AlgorithmParameter& FlightTreeParameters::info(std::string_view name) {
    PlannerSettings settings;
    settings.algorithm = "rrt-star";
    settings.variant = Variant::mp_arm_ada;
    return *algorithm_parameter(settings, name);
}

std::span<const FlightTreeParameters::Member> FlightTreeParameters::members() noexcept {
    using P = FlightTreeParameters;
    static constexpr std::array all{
        Member{"first_goal_bias", &P::first_goal_bias},
        Member{"goal_bias", &P::goal_bias},
        Member{"local_bias", &P::local_bias},
        Member{"local_radius_m", &P::local_radius_m},
        Member{"passage_share", &P::passage_share},
        Member{"way_share", &P::way_share},
        Member{"range_share", &P::range_share},
        Member{"optimism", &P::optimism},
        Member{"max_detour", &P::max_detour},
        Member{"alternative_distance_m", &P::alternative_distance_m},
        Member{"worthwhile_gain", &P::worthwhile_gain},
        Member{"final_gain", &P::final_gain},
        Member{"batch_size", &P::batch_size},
        Member{"first_batch_size", &P::first_batch_size},
        Member{"round_work", &P::round_work},
        Member{"max_round_work", &P::max_round_work},
        Member{"execution_tick_work", &P::execution_tick_work},
        Member{"sample_work", &P::sample_work},
        Member{"usual_sample_work", &P::usual_sample_work},
        Member{"refine_work", &P::refine_work},
        Member{"max_rejected_at_end", &P::max_rejected_at_end},
    };
    return all;
}

}  // namespace downwash::planning
