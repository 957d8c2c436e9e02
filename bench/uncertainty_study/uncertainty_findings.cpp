#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "downwash/bench/campaign_rows.hpp"
#include "downwash/bench/uncertainty_study/uncertainty_figures.hpp"

namespace downwash::bench {
namespace {

/// Setups that plan in several worlds of their setting.
bool is_robust(const SetupFigures& setup) {
    return setup.certifies;
}

const SetupFigures* named(const std::vector<SetupFigures>& setups, const std::string& name) {
    const auto found = std::find_if(setups.begin(), setups.end(), [&](const auto& s) { return s.setup == name; });
    return found != setups.end() ? &*found : nullptr;
}

/// The best of the setups that know nothing of worlds, chosen after the fact.
const SetupFigures* most_reliable_as_believed(const std::vector<SetupFigures>& setups) {
    const SetupFigures* best = nullptr;
    for (const SetupFigures& setup : setups) {
        if (setup.setup.find("nominal") != std::string::npos &&
            (best == nullptr || setup.reliable.hits > best->reliable.hits)) {
            best = &setup;
        }
    }
    return best;
}

double ratio_of(const Share& share) {
    return static_cast<double>(share.hits) / static_cast<double>(share.attempts);
}

std::string count_text(const Share& share) {
    return fmt::format("{} of {}", share.hits, share.attempts);
}

Finding failure_share(const std::string& name, std::uint64_t failures, std::uint64_t flights, bool is_to_be_small) {
    Finding finding{name, {}, is_to_be_small ? "at most 0.01" : "more than 0.01", "no plan was flown", false};
    if (flights > 0) {
        finding.measured = static_cast<double>(failures) / static_cast<double>(flights);
        finding.basis = fmt::format("{} of {} flights", failures, flights);
        finding.is_reproduced = (*finding.measured <= max_failure_share) == is_to_be_small;
    }
    return finding;
}

/// Among all setups of a setting that certify, or the reference setup.
Finding certified_failures(const std::string& name, const std::vector<SetupFigures>& setups) {
    std::uint64_t failures = 0, flights = 0;
    for (const SetupFigures& setup : setups) {
        if (is_robust(setup)) {
            failures += setup.in_worlds.failed.hits;
            flights += setup.in_worlds.failed.attempts;
        }
    }
    return failure_share(name, failures, flights, true);
}

/// How much more often the one is reliable than the other.
Finding reliable_lead(const std::string& name, const SetupFigures* ours, const SetupFigures* rival) {
    Finding finding{name, {}, "at least 0", "no such runs", false};
    if (ours != nullptr && rival != nullptr && ours->attempted > 0 && rival->attempted > 0) {
        finding.measured = ratio_of(ours->reliable) - ratio_of(rival->reliable);
        finding.basis = fmt::format("{}: {}; {}: {}", ours->setup, count_text(ours->reliable), rival->setup,
                                    count_text(rival->reliable));
        finding.is_reproduced = *finding.measured >= 0;
    }
    return finding;
}

Finding at_most(const std::string& name, double measured, double target, std::string basis) {
    const bool is_known = std::isfinite(measured);
    return {name, is_known ? std::optional(measured) : std::nullopt, fmt::format("at most {}", target),
            std::move(basis), is_known && measured <= target};
}

}  // namespace

std::vector<Finding> findings_of(const std::vector<SetupFigures>& all) {
    std::vector<SetupFigures> own, camp;
    for (const SetupFigures& setup : all) {
        (setup.setting == all.front().setting ? own : camp).push_back(setup);
    }
    const SetupFigures* nominal = named(own, reference_setup);
    const SetupFigures* robust = named(own, "mp-arm-ada, 8 worlds");
    std::vector<Finding> findings{certified_failures("failure share of certified plans", own)};
    if (nominal != nullptr) {
        findings.push_back(failure_share("failure share of nominal plans", nominal->in_worlds.failed.hits,
                                         nominal->in_worlds.failed.attempts, false));
    }
    findings.push_back(reliable_lead("searches with a reliable plan, 8 worlds over the best margin found afterwards",
                                     robust, most_reliable_as_believed(own)));
    findings.push_back(reliable_lead("searches with a reliable plan, 8 worlds over one pessimistic world", robust,
                                     named(own, "mp-arm-ada, one pessimistic world, margin 0.1 m")));
    if (robust != nullptr && nominal != nullptr) {
        findings.push_back(at_most("cost of plans in 8 worlds over nominal plans",
                                   robust->pairs > 0 ? robust->cost_ratio.median : infinite, 1.1,
                                   fmt::format("median of {} pairs", robust->pairs)));
        findings.push_back(
            at_most("time to the first certified plan over the time to a first nominal plan",
                    robust->in_worlds.first_certified_s.median / nominal->first_solution_s.median, 100,
                    fmt::format("{:.3g} s and {:.3g} s, medians over all searches",
                                robust->in_worlds.first_certified_s.median, nominal->first_solution_s.median)));
    }
    findings.push_back(certified_failures("failure share of certified plans in CAMP's setting", camp));
    return findings;
}

}  // namespace downwash::bench
