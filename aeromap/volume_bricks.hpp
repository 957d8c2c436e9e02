#pragma once

// Private to aeromap.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <unordered_set>
#include <vector>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/aeromap/known_factors.hpp"
#include "downwash/aeromap/same_along.hpp"
#include "downwash/aeromap/volume_view.hpp"
#include "downwash/base/bounds.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// A brick with the memory of what it holds. Nodes and polynomials keep their places while it grows.
struct OwnedBrick : VolumeBrick {
    OwnedBrick() : VolumeBrick{} {}
    OwnedBrick(const OwnedBrick&) = delete;
    OwnedBrick& operator=(const OwnedBrick&) = delete;

    /// Gives an unknown node its content: readers see all of it or nothing. @pre the lock is held
    void publish(VolumeNode& node, const VolumeNode& content);
    /// Two nodes that are unknown.
    VolumeNode* new_halves() { return all_halves.emplace_back().data(); }
    const Triquadratic* keep(const Triquadratic& polynomial) { return &all_polynomials.emplace_back(polynomial); }
    const Triquadratic* keep(const Triquadratic& all, const Triquadratic& above);
    [[nodiscard]] std::size_t polynomials() const { return all_polynomials.size() + 2 * all_pairs.size(); }
    [[nodiscard]] std::size_t memory_bytes() const;

    mutable std::mutex mutex;  ///< guards all below, and writing to nodes
    std::deque<std::array<VolumeNode, 2>> all_halves;
    std::deque<Triquadratic> all_polynomials;
    std::deque<std::array<Triquadratic, 2>> all_pairs;
    /// K at points that boxes share, for as long as the brick is asked often. Nothing depends on what is known.
    KnownFactors samples;
    bool is_calm = false;  ///< no surface has an effect; boxes only say where one may fly
    SameAlong same_along;  ///< in the whole brick
};

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

/// A volume has no more bricks than this: half a gigabyte of addresses, of which only those become memory that are near
/// a place asked for.
inline constexpr std::size_t max_volume_bricks = std::size_t{1} << 26U;
/// A cell's edge is no longer than this times R: no obstacle is missed.
inline constexpr double longest_cell_radii = 0.45;

/// Whether a block has no more bricks than a volume may have.
[[nodiscard]] bool has_few_bricks(const Bounds& extent, double lateral_low_m, double lateral_high_m, double radius_m);

/// What a volume interpolates, evaluated directly; see direct_value().
[[nodiscard]] SidedFactor<double> direct_value(const DirectEffect& effect, const Vector3& hub_m);

/// A brick of which nothing is known.
/// @return null where no surface has an effect, and the flyable area's end is at least R away from all cells
[[nodiscard]] std::unique_ptr<OwnedBrick> make_brick(const DirectEffect& effect, const VolumeGrid& grid,
                                                     std::size_t number);

/// Makes a box known, and all halvings that lead to it. What they are is a function of effect, grid and place alone.
/// @pre the brick's lock is held
void explore(const DirectEffect& effect, const VolumeGrid& grid, const PlaceInBrick& place, OwnedBrick& brick);
/// The same of all boxes of a brick.
void explore_all(const DirectEffect& effect, const VolumeGrid& grid, std::size_t number, OwnedBrick& brick);

/// Whether a sample that a brick was made from is what the effect gives today.
[[nodiscard]] bool agrees_with_effect(const DirectEffect& effect, const VolumeGrid& grid, std::size_t number,
                                      const VolumeBrick& brick);

/// What copies of a volume share: its bricks, and how to look into them. Safe to share between threads.
class VolumeBricks {
 public:
    /// @throws InputError as VolumeMap
    VolumeBricks(std::shared_ptr<const DirectEffect> effect, const PlaneOfMotion& frame, const Bounds& extent,
                 double lateral_low_m, double lateral_high_m);

    [[nodiscard]] const std::shared_ptr<const DirectEffect>& effect() const noexcept { return effect_; }
    [[nodiscard]] const VolumeGrid& grid() const noexcept { return grid_; }
    [[nodiscard]] VolumeView view() noexcept;

    /// A brick, made if nobody has asked for it before.
    const VolumeBrick& made(std::size_t number);
    void explore(const PlaceInBrick& place);
    /// Makes all boxes known. @throws WorkStopped when it is over before
    void fill(int threads, const std::function<void(double)>& on_progress, const StopCondition& is_over);

    /// The numbers of the bricks that somebody has asked for, in their order.
    [[nodiscard]] std::vector<std::size_t> made() const;
    /// The numbers of those in which something has become known here since the last call: all but what was adopted.
    [[nodiscard]] std::vector<std::size_t> take_new();
    /// A brick with its memory; null where nothing has an effect. @pre it is made
    [[nodiscard]] OwnedBrick* owned(std::size_t number) const;

    /// Adds what another brick of this number knows; null: a calm one.
    void adopt(std::size_t number, std::unique_ptr<OwnedBrick> brick);

    [[nodiscard]] std::size_t polynomials() const;
    [[nodiscard]] std::size_t memory_bytes() const;
    /// What all threads together have spent on filling so far [s].
    [[nodiscard]] double filling_s() const noexcept { return 1e-9 * static_cast<double>(filling_ns_.load()); }

 private:
    [[nodiscard]] VolumeBrick* place(std::size_t number) const noexcept;
    /// Puts a brick in its place, unless there is one.
    void put(std::size_t number, std::unique_ptr<OwnedBrick> brick);
    void note_explored(std::size_t number);
    template <class Each>
    void for_each_owned(const Each& each) const;

    struct Free {
        void operator()(VolumeBrick** places) const noexcept {
            std::free(static_cast<void*>(places));  // NOLINT(cppcoreguidelines-no-malloc): of calloc
        }
    };

    std::shared_ptr<const DirectEffect> effect_;
    VolumeGrid grid_;
    std::unique_ptr<VolumeBrick> calm_;
    std::unique_ptr<VolumeBrick*[], Free> places_;  ///< of all bricks; read by everybody, by atomic loads
    mutable std::mutex mutex_;                      ///< guards all below, and writing to places_
    std::vector<std::unique_ptr<OwnedBrick>> owned_;
    std::vector<std::size_t> made_;
    std::unordered_set<std::size_t> new_;
    std::deque<OwnedBrick*> lately_;  ///< bricks that keep their samples
    std::atomic<std::int64_t> filling_ns_{0};
};

}  // namespace downwash
