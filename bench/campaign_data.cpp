#include "downwash/bench/campaign_data.hpp"

#include <algorithm>
#include <array>

#include "downwash/base/text.hpp"

namespace downwash::bench {

std::string Experiment::name() const {
    return problem + ", " + objective;
}

std::string_view Experiment::cost_unit() const {
    const auto* const single = std::find_if(all_objectives.begin(), all_objectives.end(),
                                            [&](Objective each) { return downwash::name_of(each) == objective; });
    return single != all_objectives.end() ? unit_of(*single) : "";
}

std::string text_of(const ParameterValues& parameters) {
    return joined(parameters, ", ", [](const auto& named) { return named.first + " " + to_text(named.second); });
}

std::string PlannerSetup::name() const {
    return std::string(downwash::name_of(variant)) + " " + algorithm +
           (parameters.empty() ? "" : ", " + text_of(parameters)) +
           (margin_m ? ", margin " + to_text(*margin_m) + " m" : "");
}

std::string_view name_of(RunStatus status) {
    constexpr std::array<std::string_view, run_status_count> names{"none", "approximate", "solved", "impossible",
                                                                   "error"};
    return names[static_cast<std::size_t>(status)];
}

std::vector<SeedRange> ranges_of(const std::vector<std::uint32_t>& seeds) {
    std::vector<SeedRange> ranges;
    for (const std::uint32_t seed : seeds) {
        if (!ranges.empty() && seed != 0 && seed - 1 == ranges.back().last) {
            ranges.back().last = seed;
        } else {
            ranges.push_back({seed, seed});
        }
    }
    return ranges;
}

std::string seeds_text(const std::vector<std::uint32_t>& seeds) {
    return joined(ranges_of(seeds), " ", [](const SeedRange& range) {
        return std::to_string(range.first) + (range.last != range.first ? "-" + std::to_string(range.last) : "");
    });
}

}  // namespace downwash::bench
