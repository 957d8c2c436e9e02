#pragma once

// Private to aeromap.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/aeromap/block_store.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/aeromap/volume_view.hpp"
#include "downwash/base/bounds.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// A brick with the memory of what it holds.
struct OwnedBrick : VolumeBrick {
    OwnedBrick() : VolumeBrick{} {
        for (VolumeNode& cell : cells) {
            cell = VolumeNode::of(VolumeNodeKind::calm, 0, 0);
        }
    }
    OwnedBrick(const OwnedBrick&) = delete;
    OwnedBrick& operator=(const OwnedBrick&) = delete;

    /// Ends the filling: what it holds is what look-ups find from now on, and must not change.
    void seal();

    std::vector<VolumeNode> all_nodes;
    std::vector<Triquadratic> all_polynomials;
};

/// Whether look-ups find the same in both.
[[nodiscard]] bool operator==(const VolumeBrick& a, const VolumeBrick& b);

/// The cells of a volume.
struct VolumeGrid {
    PlaneOfMotion frame;
    Vector3 low_m{}, high_m{};  ///< corners, in the frame: x, lateral, z
    Vector3 cell_m{};           ///< a cell's edges
    std::array<std::uint32_t, 3> cells{};
    std::array<std::uint32_t, 3> bricks{};

    /// Position along the bricks of one with a number.
    [[nodiscard]] std::array<std::uint32_t, 3> brick_at(std::size_t number) const noexcept {
        return {static_cast<std::uint32_t>(number % bricks[0]),
                static_cast<std::uint32_t>(number / bricks[0] % bricks[1]),
                static_cast<std::uint32_t>(number / bricks[0] / bricks[1])};
    }
    [[nodiscard]] std::size_t brick_count() const noexcept { return std::size_t{bricks[0]} * bricks[1] * bricks[2]; }
};

/// What a volume interpolates, evaluated directly; see direct_value().
[[nodiscard]] SidedFactor<double> direct_value(const DirectEffect& effect, const Vector3& hub_m);

/// A brick: a pure function of effect, grid and number.
/// @return null where no surface has an effect, and the flyable area's end is at least R away from all cells
[[nodiscard]] std::shared_ptr<const OwnedBrick> make_brick(const DirectEffect& effect, const VolumeGrid& grid,
                                                           std::size_t number);

/// What copies of a volume share: its bricks, and how to fill them. Safe to share between threads.
class VolumeBricks {
 public:
    /// @throws InputError as VolumeMap
    VolumeBricks(std::shared_ptr<const DirectEffect> effect, const PlaneOfMotion& frame, const Bounds& extent,
                 double lateral_low_m, double lateral_high_m);

    [[nodiscard]] const std::shared_ptr<const DirectEffect>& effect() const noexcept { return effect_; }
    [[nodiscard]] const VolumeGrid& grid() const noexcept { return grid_; }
    [[nodiscard]] VolumeView view() noexcept;

    /// A brick, filled if need be. While another thread fills it, this one fills a neighbour, and then waits.
    const VolumeBrick& filled(std::size_t number);

    /// Fills all bricks. @throws WorkStopped when it is over before
    void fill(int threads, const std::function<void(double)>& on_progress, const StopCondition& is_over);

    [[nodiscard]] BlockStore<VolumeBrick>& store() noexcept { return store_; }
    [[nodiscard]] const BlockStore<VolumeBrick>& store() const noexcept { return store_; }
    /// The brick that stands for all in which nothing has an effect.
    [[nodiscard]] const std::shared_ptr<const VolumeBrick>& calm() const noexcept { return calm_; }

    /// What all threads together have spent on filling so far [s].
    [[nodiscard]] double filling_s() const noexcept { return 1e-9 * static_cast<double>(filling_ns_.load()); }

 private:
    [[nodiscard]] std::shared_ptr<const VolumeBrick> made(std::size_t number);
    void look_ahead(std::size_t number);

    std::shared_ptr<const DirectEffect> effect_;
    VolumeGrid grid_;
    std::shared_ptr<const VolumeBrick> calm_;
    BlockStore<VolumeBrick> store_;
    std::atomic<std::int64_t> filling_ns_{0};
};

}  // namespace downwash
