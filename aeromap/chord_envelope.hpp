#pragma once

// Private to aeromap.

#include <cstddef>
#include <memory_resource>
#include <vector>

#include "downwash/aeromap/disc_query.hpp"

namespace downwash {

/// The mean of the factor over a straight slope from one distance to another.
[[nodiscard]] double mean_factor(const DiscQuery& query, double one_m, double other_m);

/// A straight piece of a surface along a chord: its gap from the rotor plane at both ends.
struct SurfaceStretch {
    double low, high;
    double gap_low, gap_high;

    [[nodiscard]] double gap_at(double u) const { return gap_low + (gap_high - gap_low) * ((u - low) / (high - low)); }
};

/// The first surface along a chord among straight pieces of surfaces.
class ChordEnvelope {
 public:
    /// @param background_m gap of what lies behind all pieces; infinite for nothing
    ChordEnvelope(const DiscQuery& query, double background_m, std::pmr::memory_resource* memory);

    void clear() noexcept { stretches_.clear(); }
    /// One without width counts for nothing. @pre its gaps are finite and at least 0
    void add(const SurfaceStretch& stretch) {
        if (stretch.low < stretch.high) {
            stretches_.push_back(stretch);
        }
    }

    /// Integral along the chord of k beyond the background's.
    [[nodiscard]] double excess();

 private:
    /// The first surface at a point, and its gap there.
    struct First {
        std::size_t stretch;
        double gap;
    };
    [[nodiscard]] First first_at(double u) const;
    [[nodiscard]] double gap_of(std::size_t stretch, double u) const;
    [[nodiscard]] double between(double low, double high, First at_low, First at_high, int splits) const;
    [[nodiscard]] double straight(double low, double high, double gap_low, double gap_high) const;

    const DiscQuery& query_;
    double background_m_;
    double background_;
    std::pmr::vector<SurfaceStretch> stretches_;
    std::pmr::vector<double> cuts_;
    std::pmr::vector<SurfaceStretch> open_;  ///< over the present piece
};

}  // namespace downwash
