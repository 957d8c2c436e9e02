#include "downwash/simulation/space_hold_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/base/text.hpp"
#include "downwash/simulation/hold_map.hpp"

namespace downwash {
namespace {

SpaceHoldMap empty_map(const Vector3& low_m, const Vector3& high_m, double step_m) {
    if (!(step_m > 0 && std::isfinite(step_m))) {
        throw InputError({KeyError{"step_m", "is " + to_text(step_m) + ": expected a distance above 0 m"}});
    }
    SpaceHoldMap map{low_m, step_m, {}, {}};
    double all = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(high_m[axis] >= low_m[axis])) {
            throw InputError({KeyError{"bounds", "are empty: expected no end below the other, along x, y and z"}});
        }
        const double nodes = std::floor((high_m[axis] - low_m[axis]) / step_m + 1e-9) + 1;
        all *= nodes;
        if (!(all <= max_hold_nodes)) {
            throw InputError({KeyError{"step_m", "is " + to_text(step_m) + ", which would give more than " +
                                                     to_text(max_hold_nodes) + " nodes: expected a larger one"}});
        }
        map.nodes[axis] = static_cast<std::size_t>(nodes);
    }
    map.all.resize(static_cast<std::size_t>(all));
    return map;
}

}  // namespace

SpaceHoldNode node_of(const SpaceHoverAnalysis& analysis) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const bool has_modes = analysis.verdict >= HoldVerdict::unstable;
    const SpaceHoverStability& stability = analysis.stability;
    return {analysis.verdict,
            analysis.trim.limit,
            has_modes ? stability.growth_rate_1_s : unknown,
            has_modes ? stability.frequency_rad_s : unknown,
            stability.slowest_loop,
            analysis.trim.tilt_rad,
            analysis.trim.saturation};
}

SpaceHoldMap make_space_hold_map(const SpaceHover& hover, const Vector3& low_m, const Vector3& high_m, double step_m,
                                 const SpacePoint& pose, int threads) {
    SpaceHoldMap map = empty_map(low_m, high_m, step_m);
    // Some nodes a task: what a task remembers of the surfaces serves them all.
    constexpr std::size_t together = 32;
    run_parallel((map.all.size() + together - 1) / together, threads, [&](std::size_t task) {
        const auto surfaces = hover.direct_effect();
        for (std::size_t i = task * together; i < std::min(map.all.size(), (task + 1) * together); ++i) {
            SpacePoint place = rest_at(pose);
            const Vector3 at_m = map.place_m(i);
            std::copy(at_m.begin(), at_m.end(), place.position);
            map.all[i] = node_of(hover.at(place, *surfaces));
        }
    });
    return map;
}

}  // namespace downwash
