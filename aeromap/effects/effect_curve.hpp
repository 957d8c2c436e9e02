#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "downwash/effects/effect_models.hpp"

namespace downwash {

/// K over zeta = z/R of one wide flat surface, clamped as it is used. Immutable and safe to share.
class DOWNWASH_EXPORT EffectCurve {
 public:
    /// A rotor's K: the formula clamped to [1, max_factor]; a table to [0, max_factor].
    /// @pre max_factor >= 1
    EffectCurve(SurfaceEffect effect, double max_factor, RotorNeighbours neighbours = {});

    /// What the fountain adds to a vehicle's thrust: 1 + K(multirotor-body) - K(multirotor-images), each clamped.
    [[nodiscard]] static EffectCurve fountain(const SurfaceEffect& effect, double max_factor,
                                              const RotorNeighbours& neighbours);

    /// What the image of one rotor does to another: 1 + image_loss(z/R, distance_radii), at most max_factor.
    [[nodiscard]] static EffectCurve image(double distance_radii, double max_factor);

    /// @param z_over_r >= 0, infinite for no surface (then 1)
    [[nodiscard]] double operator()(double z_over_r) const;

    /// Upper bound of |K - 1| at `z_over_r` and beyond. Exact for formulas that fall with distance, up to a few percent
    /// too large for others.
    [[nodiscard]] double largest_change_beyond(double z_over_r) const;

    /// Bound of |K(zeta) - K(far)| for all zeta from `near` to `far`; exact for formulas that fall with distance.
    [[nodiscard]] double largest_difference(double near, double far) const;

    /// The farthest distance in radii at which K reaches its cap; negative if it never does. A curve that depends on a
    /// wall is taken without one.
    [[nodiscard]] double cap_distance() const noexcept { return cap_distance_; }

    /// Up to this distance in radii K may be constant although the air is not: at the cap, or before a table's first
    /// row. Negative: nowhere. For a table that depends on a wall: whatever the wall, exact to one row.
    [[nodiscard]] double flat_distance() const noexcept { return flat_distance_; }

    /// K never rises on the way outwards, and ends at 1.
    [[nodiscard]] bool falls_with_distance() const noexcept { return falls_with_distance_; }

    /// K is 1 everywhere.
    [[nodiscard]] bool is_none() const noexcept { return effect_.model == EffectModel::none; }

    /// K is a table over (z/R, d/R), and d is the distance to a wall. Use at_wall() to get the curve.
    [[nodiscard]] bool depends_on_wall() const noexcept;
    /// The curve of a rotor with the nearest wall d_over_r away (infinite: none). @pre depends_on_wall()
    [[nodiscard]] EffectCurve at_wall(double d_over_r) const;

    [[nodiscard]] const SurfaceEffect& effect() const noexcept { return effect_; }
    [[nodiscard]] const RotorNeighbours& neighbours() const noexcept { return neighbours_; }
    [[nodiscard]] bool is_fountain() const noexcept { return kind_ == Kind::fountain; }
    /// Of image(): the distance; else 0.
    [[nodiscard]] double image_distance_radii() const noexcept { return image_distance_radii_; }

 private:
    enum class Kind : std::uint8_t { rotor, fountain, image };

    [[nodiscard]] double clamped(double factor) const noexcept;
    void prepare();

    SurfaceEffect effect_;
    RotorNeighbours neighbours_;
    double max_factor_;
    Kind kind_ = Kind::rotor;
    double image_distance_radii_ = 0;
    bool falls_with_distance_ = true;
    double cap_distance_ = -1;
    double flat_distance_ = -1;
    /// Largest |K - 1| from each of the bounding distances on; empty when K falls with distance.
    std::shared_ptr<const std::vector<double>> changes_;
};

}  // namespace downwash
