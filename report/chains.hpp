#pragma once

// Private to report.

#include <set>
#include <utility>
#include <vector>

namespace downwash {

/// Removes all steps from a map or multimap of places to their successors and joins them to chains: first open ones,
/// then closed ones, whose last place is their first.
template <class Steps>
std::vector<std::vector<typename Steps::key_type>> take_chains(Steps& steps) {
    using Place = typename Steps::key_type;
    std::set<Place> arrivals;
    for (const auto& [from, to] : steps) {
        arrivals.insert(to);
    }
    std::vector<Place> beginnings;
    for (const auto& [from, to] : steps) {
        if (arrivals.count(from) == 0) {
            beginnings.push_back(from);
        }
    }
    std::vector<std::vector<Place>> chains;
    const auto follow = [&](Place first) {
        std::vector<Place> chain{first};
        for (auto step = steps.find(first); step != steps.end(); step = steps.find(chain.back())) {
            chain.push_back(step->second);
            steps.erase(step);
            if (chain.back() == first) {
                break;
            }
        }
        chains.push_back(std::move(chain));
    };
    for (const Place& beginning : beginnings) {
        follow(beginning);
    }
    while (!steps.empty()) {
        follow(steps.begin()->first);
    }
    return chains;
}

}  // namespace downwash
