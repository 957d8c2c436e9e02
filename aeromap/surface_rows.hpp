#pragma once

// Private to aeromap.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "downwash/aeromap/disc_query.hpp"
#include "downwash/aeromap/outline_crossings.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// Level lines through the world, all in one direction, at equal distances. Discs among many parts are averaged along
/// them, so that what a line meets is worked out once for all discs. The direction is one to which hardly any edge is
/// parallel: an error of the average would not cancel along an edge between two lines.
struct RowLattice {
    double radius_m;  ///< of the discs
    int level;        ///< 0 to row_levels - 1: how close the lines are

    /// Lines in a radius, by level.
    static constexpr std::array<int, 3> rows_in_radius{3, 8, 32};

    [[nodiscard]] double spacing_m() const noexcept {
        return radius_m / rows_in_radius[static_cast<std::size_t>(level)];
    }
    [[nodiscard]] std::int64_t row_before(double v_m) const noexcept {
        return static_cast<std::int64_t>(std::floor(v_m / spacing_m()));
    }
    /// The middle of the strip that the row stands for.
    [[nodiscard]] double v_of(std::int64_t row) const noexcept {
        return (static_cast<double>(row) + 0.5) * spacing_m();
    }
    /// Coordinates of all lattices: u along rows and v across, from the origin of the world. The angle is 20.5 degrees:
    /// off those of which drawings are made.
    [[nodiscard]] static ChordFrame frame(double radius_m) noexcept {
        return {0, 0, radius_m, 0.93667218924839757, 0.35020738125946743};
    }
};
inline constexpr int row_levels = static_cast<int>(RowLattice::rows_in_radius.size());

/// A rectangle along and across rows [m].
struct RowWindow {
    Interval u_m, v_m;
};

/// Heights between which hubs see the same surfaces, `low_m` < hub < `high_m`: either no part of the surroundings
/// reaches there, or it is so thin that a disc in the flyable area has nothing there above or below it.
struct Slab {
    double low_m, high_m;
    bool is_empty;  ///< nothing reaches there
};

/// The first surface on one side of a slab along the rows in a window. Immutable.
class SurfaceRows {
 public:
    /// @param parts those whose shadows may meet the window
    SurfaceRows(const Scene& scene, std::span<const std::uint32_t> parts, const RowLattice& lattice,
                const RowWindow& window, Side side, const Slab& slab);

    [[nodiscard]] const RowLattice& lattice() const noexcept { return lattice_; }

    /// Whether something reaches into the slab over a stretch of a row: what is first depends on the hub's height
    /// there.
    [[nodiscard]] bool is_blocked(std::int64_t row, double low_m, double high_m) const noexcept {
        return blocked_.meets(index(row), low_m, high_m);
    }
    /// Whether something lies along a stretch of a row that is so thin that no row may meet it.
    [[nodiscard]] bool is_passed_by(std::int64_t row, double low_m, double high_m) const noexcept {
        return passed_by_.meets(index(row), low_m, high_m);
    }

    [[nodiscard]] bool has_blocked() const noexcept { return !blocked_.all.empty(); }
    [[nodiscard]] bool has_passed_by() const noexcept { return !passed_by_.all.empty(); }

    /// Calls `use(length, gap_low, gap_high, per_slope)` with each straight piece of the first surface over a stretch
    /// of a row: how long it is, its gaps from the hub's plane at both ends, and how far along the row the gap grows by
    /// as much; infinite for a level piece. Nothing where there is no surface.
    template <class Use>
    void visit(std::int64_t row, double low_m, double high_m, double hub_z_m, const Use& use) const {
        const std::size_t i = index(row);
        const double place = (low_m - u_low_m_) * buckets_per_m_;
        const auto bucket = static_cast<std::size_t>(
            std::clamp(static_cast<std::int32_t>(place), std::int32_t{0}, static_cast<std::int32_t>(buckets - 1)));
        const double hub = is_below_ ? hub_z_m : -hub_z_m;
        const std::uint32_t end = starts_[(i + 1) * buckets];
        for (std::uint32_t k = starts_[i * buckets + bucket]; k < end && pieces_[k].low < high_m; ++k) {
            const Piece& piece = pieces_[k];
            const double low = std::max(piece.low, low_m);
            const double high = std::min(piece.high, high_m);
            if (low < high) {
                use(high - low, hub - piece.line.at(low), hub - piece.line.at(high), piece.per_slope);
            }
        }
    }

    /// The gap of a hub from the one level surface that is all there is in the window; empty if it is not.
    [[nodiscard]] std::optional<double> level_gap_m(double hub_z_m) const noexcept {
        return level_rise_m_ ? std::optional(std::max(0.0, (is_below_ ? hub_z_m : -hub_z_m) - *level_rise_m_))
                             : std::nullopt;
    }

    [[nodiscard]] std::size_t bytes() const noexcept;

    /// A straight surface along a row. Its rise is the height towards the hubs: upwards, if these are above.
    struct Line {
        double u, rise, slope;
        [[nodiscard]] double at(double there) const noexcept { return rise + slope * (there - u); }
    };
    struct Piece {
        double low, high;
        Line line;
        double per_slope = 0;  ///< of the gap: -1 / line.slope
    };

 private:
    static constexpr std::size_t buckets = 16;  ///< over the window, of each row, to find pieces sooner

    /// Stretches of one row after the other.
    struct Stretches {
        std::vector<Interval> all;
        std::vector<std::uint32_t> starts{0};  ///< of each row; behind the last one, the count

        void add_row(const std::vector<Interval>& row);
        [[nodiscard]] bool meets(std::size_t row, double low_m, double high_m) const noexcept {
            return !all.empty() && std::any_of(all.begin() + starts[row], all.begin() + starts[row + 1],
                                               [&](const Interval& x) { return x.low < high_m && x.high > low_m; });
        }
        [[nodiscard]] std::size_t bytes() const noexcept {
            return all.capacity() * sizeof(Interval) + starts.capacity() * sizeof(std::uint32_t);
        }
    };

    [[nodiscard]] std::size_t index(std::int64_t row) const noexcept {
        return static_cast<std::size_t>(row - first_row_);
    }
    void add_starts(std::size_t first);
    [[nodiscard]] std::optional<double> level_rise_m(const RowWindow& window) const;

    RowLattice lattice_;
    bool is_below_;
    std::int64_t first_row_;
    double u_low_m_;
    double buckets_per_m_;
    std::vector<Piece> pieces_;          ///< of one row after the other, along each
    std::vector<std::uint32_t> starts_;  ///< first piece that reaches into a bucket; behind the last one, the count
    Stretches blocked_, passed_by_;
    std::optional<double> level_rise_m_;
};

}  // namespace downwash
