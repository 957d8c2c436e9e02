#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "downwash/planner/found.hpp"
#include "downwash/search/search_record.hpp"

namespace downwash::planning {

/// What a search, or all searches for the goals of a problem, came to.
template <class Family>
struct SearchResultOf {
    using Found = FoundOf<Family>;

    Found found;
    SearchRecord record;         ///< how it went
    std::uint64_t attempts = 0;  ///< plans that asked for a certificate, those before the search included
    /// The goal before, from 0, the way to which has to be searched anew: its flights fail most often in the worlds of
    /// certificates, so that no way from there helps. Of a search for the way to one of several goals.
    std::optional<std::size_t> weak_goal = {};
    /// The goal, from 0, for which all searches together were in vain for so long that the sequence ended before its
    /// limits. Of a search for several goals.
    std::optional<std::size_t> hard_goal = {};
};
using SearchResult = SearchResultOf<Plane>;

}  // namespace downwash::planning
