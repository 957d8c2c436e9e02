#pragma once

// Private to aeromap.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "downwash/aeromap/surface_rows.hpp"
#include "downwash/base/export.hpp"

namespace downwash {

/// What stands over and under the discs whose hubs are in one square of a lattice of squares. Safe to share between
/// threads.
class RowColumn {
 public:
    /// @param hubs along and across rows
    RowColumn(const Scene& scene, double radius_m, const RowWindow& hubs);

    /// Heights around a hub; empty for a hub at the very height where a part ends.
    [[nodiscard]] std::optional<Slab> slab_around(double z_m) const;

    /// A lower bound of the distance to what is over or under a disc on the query's side [m]: from the boxes of the
    /// parts in the square around the disc; 0 where one of them is cut by the rotor plane, infinite without any.
    [[nodiscard]] double nearest_gap_m(const DiscQuery& query) const noexcept;

    /// The first surface on one side of a slab; made when it is first asked for.
    /// @param slab of slab_around()   @param[out] made_bytes size of what was made, 0 if it was there
    [[nodiscard]] std::shared_ptr<const SurfaceRows> rows(Side side, int level, const Slab& slab,
                                                          std::size_t& made_bytes) const;

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }

 private:
    struct Kept {
        double slab_low_m, slab_high_m;
        Side side;
        int level;
        std::shared_ptr<const SurfaceRows> rows;
    };

    const Scene& scene_;
    double radius_m_;
    RowWindow window_;                  ///< of the discs
    std::vector<std::uint32_t> parts_;  ///< in their order
    std::vector<BoundingBox> bounds_;   ///< of the parts
    std::vector<Interval> heights_m_;   ///< where parts reach, from below, apart from each other
    mutable std::mutex mutex_;          ///< of kept_
    mutable std::vector<Kept> kept_;
    mutable std::atomic<std::size_t> bytes_;
};

/// The columns of a scene for the discs of one radius, made when they are first asked for and dropped when they take
/// too much memory. What is asked for in which order, and by how many threads, changes nothing. Safe to share between
/// threads.
class RowColumns {
 public:
    /// @param scene must live as long as this   @param max_bytes for all columns, about
    DOWNWASH_EXPORT RowColumns(const Scene& scene, double radius_m, std::size_t max_bytes = default_max_bytes);
    DOWNWASH_EXPORT ~RowColumns();
    RowColumns(const RowColumns&) = delete;
    RowColumns& operator=(const RowColumns&) = delete;

    static constexpr std::size_t default_max_bytes = std::size_t{128} << 20U;

    [[nodiscard]] double radius_m() const noexcept { return radius_m_; }

    /// The column around a hub. @param u_m,v_m of the hub, at most 1e8 radii from the origin
    [[nodiscard]] std::shared_ptr<const RowColumn> at(double u_m, double v_m) const;

    /// RowColumn::rows of the column around the same hub.
    [[nodiscard]] std::shared_ptr<const SurfaceRows> rows(const RowColumn& column, double u_m, double v_m, Side side,
                                                          int level, const Slab& slab) const;

    /// The memory of all columns that are kept, about.
    [[nodiscard]] DOWNWASH_EXPORT std::size_t bytes() const;

 private:
    /// Which square a hub is in.
    struct Square {
        std::int64_t u, v;
        [[nodiscard]] bool operator==(const Square&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Square& square) const noexcept {
            std::uint64_t x = static_cast<std::uint64_t>(square.u) * 0x9E3779B97F4A7C15U;
            x ^= static_cast<std::uint64_t>(square.v) * 0xC2B2AE3D27D4EB4FU + (x >> 31U);
            return static_cast<std::size_t>(x ^ (x >> 29U));
        }
    };
    using Columns = std::unordered_map<Square, std::shared_ptr<const RowColumn>, Hash>;
    /// Columns that were asked for lately, and those of the time before, which are dropped first.
    struct Shard {
        std::mutex mutex;
        Columns late, early;
        std::size_t late_bytes = 0, early_bytes = 0;
    };
    static constexpr std::size_t shard_count = 16;

    [[nodiscard]] double square_m() const noexcept { return 2 * radius_m_; }
    [[nodiscard]] Square square_of(double u_m, double v_m) const noexcept;
    [[nodiscard]] Shard& shard_of(const Square& square) const noexcept { return shards_[Hash()(square) % shard_count]; }
    void add_bytes(Shard& shard, std::size_t bytes) const;

    const Scene& scene_;
    double radius_m_;
    std::size_t max_shard_bytes_;
    mutable std::array<Shard, shard_count> shards_;
};

}  // namespace downwash
