#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/aeromap/volume_view.hpp"
#include "downwash/base/bounds.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// K over a block of rotor positions in three dimensions, for vehicles that leave one plane. Or how near walls are, if
/// the effect is that of DirectEffect::walls_around(). Copies share what is filled.
///
/// The block is a regular grid of cells at most 0.45 R wide. A cell is halved across x, lateral or z, and its halves
/// again, until in every box the triquadratic interpolation between 27 values stays within 0.01 of the direct
/// evaluation everywhere in the flyable area (docs/model.md 4.10). A box is looked into when a look-up first asks for a
/// place in it, with the halvings that lead to it, and kept: a pure function of effect, block and place, whoever asks
/// first. Boxes that are forbidden throughout, or where K cannot differ by more than 0.006 from 1, count as 1.
/// Coefficients are kept as float.
///
/// An edge is halved at most 7 times, to R / 284 (of walls twice), and a cell at most 16 times. Boxes in which K still
/// jumps are evaluated directly. Safe to share between threads.
class DOWNWASH_EXPORT VolumeMap {
 public:
    /// Whether a block is small enough for a map, and the volume of the largest one [m3].
    [[nodiscard]] static bool fits(const Bounds& extent, double lateral_low_m, double lateral_high_m, double radius_m);
    [[nodiscard]] static double largest_m3(double radius_m);

    /// Fills nothing, and looks at nothing in the scene.
    /// @param frame x and z are those of its plane; the block reaches from `lateral_low_m` to `lateral_high_m` to its
    /// left. Boxes need fewest values where the frame's axes are those of the structure
    /// @param effect of a multirotor model: it is that of a vehicle at one heading (see neighbours_of)
    /// @throws InputError if the block is empty or not finite, or does not fit
    VolumeMap(std::shared_ptr<const DirectEffect> effect, const PlaneOfMotion& frame, const Bounds& extent,
              double lateral_low_m, double lateral_high_m);

    /// K of all surfaces at the world position of a hub; otherwise like sided_factor().
    [[nodiscard]] double factor(const Vector3& hub_m) const;

    /// K, with the part of the surfaces above: exactly 1, or all of K, where one side is all that matters. Interpolated
    /// in the block, evaluated directly outside (1 when not finite). Of walls: x and y of DirectEffect::towards_wall().
    [[nodiscard]] SidedFactor<double> sided_factor(const Vector3& hub_m) const;

    /// How far a hub is from the end of the flyable area, at least: above 0 inside it, below 0 outside. 0 where that is
    /// not known from the box around it, nor outside the block: then DirectEffect::is_flyable() tells. Never more than
    /// R [m].
    [[nodiscard]] double margin_m(const Vector3& hub_m) const;

    /// Whether a hub is inside the flyable area. Exact.
    [[nodiscard]] bool is_flyable(const Vector3& hub_m) const;

    /// Fills all that is missing, on some threads. No flight needs that.
    /// @param threads at least 1   @param on_progress see run_parallel
    /// @throws WorkStopped when it is over before; what was filled stays
    void fill(int threads = 1, const std::function<void(double)>& on_progress = {},
              const StopCondition& is_over = {}) const;

    [[nodiscard]] const DirectEffect& effect() const noexcept;
    [[nodiscard]] const PlaneOfMotion& frame() const noexcept;
    /// Valid while the map or a copy exists.
    [[nodiscard]] const VolumeView& view() const noexcept { return view_; }
    /// How many bricks of 4 x 4 x 4 cells there are, and in how many of them somebody has asked.
    [[nodiscard]] std::size_t bricks() const noexcept;
    [[nodiscard]] std::size_t filled_bricks() const;
    /// The number of polynomials that are kept now.
    [[nodiscard]] std::size_t polynomials() const;
    /// The memory that the map takes now.
    [[nodiscard]] std::size_t memory_bytes() const;
    /// What all threads together have spent on filling so far [s].
    [[nodiscard]] double filling_s() const noexcept;

    /// What is filled, as bytes: the same for the same places asked, in whatever order and on however many threads.
    /// Only a machine of the same byte order can read them.
    [[nodiscard]] std::string to_bytes() const;
    /// The bricks in which something was filled here since the last call, as bytes: not what was only read. Empty if
    /// there are none.
    [[nodiscard]] std::string take_new_bytes() const;
    /// Adds the boxes of such bytes, equal to the last bit; false, and nothing is added, if they are not of this map,
    /// or if some of their values differ from what the effect gives today.
    bool add_bytes(std::string_view bytes);

    /// A map of the same block and effect of which nothing is filled.
    [[nodiscard]] VolumeMap unfilled() const;
    /// Corners of the block, in the frame: x, lateral, z.
    [[nodiscard]] const Vector3& low_m() const noexcept;
    [[nodiscard]] const Vector3& high_m() const noexcept;

 private:
    std::shared_ptr<VolumeBricks> bricks_;
    VolumeView view_;
};

}  // namespace downwash
