#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/space_hover.hpp"

namespace downwash {

/// What a vehicle in space can do at one node of a grid.
struct SpaceHoldNode {
    HoldVerdict verdict = HoldVerdict::not_flyable;
    HoldLimit limit = HoldLimit::none;
    double growth_rate_1_s = 0;  ///< of HoverStability; NaN where there is no equilibrium
    double frequency_rad_s = 0;  ///< of that mode; NaN too
    int slowest_loop = 0;        ///< where it shows most: one of space_loops
    double tilt_rad = 0;         ///< by which the vehicle leans
    double saturation = 0;
};

[[nodiscard]] DOWNWASH_EXPORT SpaceHoldNode node_of(const SpaceHoverAnalysis& analysis);

/// Where a vehicle in space can hover with one yaw and one pose of its arm: a node of a regular grid each.
struct SpaceHoldMap {
    Vector3 low_m{};  ///< place of the first node
    double step_m = 0;
    std::array<std::size_t, 3> nodes{};  ///< along x, y and z
    std::vector<SpaceHoldNode> all;      ///< along x first, then y

    /// Where a node is. @param i of `all`
    [[nodiscard]] Vector3 place_m(std::size_t i) const noexcept {
        const auto at = [this](std::size_t axis, std::size_t k) {
            return low_m[axis] + static_cast<double>(k) * step_m;
        };
        return {at(0, i % nodes[0]), at(1, i / nodes[0] % nodes[1]), at(2, i / (nodes[0] * nodes[1]))};
    }
};

/// Analyses hover at every node low + (i, j, k) step up to a high end, which may be the low one along some axes.
/// @param pose whose yaw and joints the vehicle has   @param threads at least 1; the result does not depend on it
/// @throws InputError when an end is below the other, the step is not a positive number, or there are more than
/// max_hold_nodes
[[nodiscard]] DOWNWASH_EXPORT SpaceHoldMap make_space_hold_map(const SpaceHover& hover, const Vector3& low_m,
                                                               const Vector3& high_m, double step_m,
                                                               const SpacePoint& pose, int threads = 1);

}  // namespace downwash
