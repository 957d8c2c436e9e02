#pragma once

#include <optional>
#include <vector>

// Private to identification/.

namespace downwash::identification {

/// Distances from wide, level surfaces at which K is identified. Between two of them K is linear. At the last one,
/// which is not identified, and beyond it K is 1.
struct SurfaceNodes {
    std::optional<double> ground_m, ceiling_m;  ///< heights of the surfaces, world
    std::vector<double> z_over_r;               ///< rising, at least two where there is a surface

    /// Number of K of one surface.
    [[nodiscard]] std::size_t of_one() const noexcept { return z_over_r.empty() ? 0 : z_over_r.size() - 1; }
    /// Number of all K: those of the ground, then those of the ceiling.
    [[nodiscard]] std::size_t count() const noexcept {
        return of_one() * ((ground_m ? 1U : 0U) + (ceiling_m ? 1U : 0U));
    }
};

}  // namespace downwash::identification
