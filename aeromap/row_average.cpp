#include "downwash/aeromap/row_average.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

#include "downwash/aeromap/chord_envelope.hpp"
#include "downwash/base/infinity.hpp"
#include "downwash/base/lane_math.hpp"

namespace downwash {
namespace {

using std::numbers::pi;

/// From half of this doubt on the next level takes over.
constexpr double allowed_doubt = 5e-4;
/// With more doubt at the last level the parts are taken one by one.
constexpr double last_doubt = 1e-3;
/// Where all surfaces over or under the disc change K by less, a level is enough; up to twice this it counts for less
/// and less.
constexpr std::array<double, row_levels> low_stake{0.004, infinity, infinity};
/// Where they change K by more, nothing may lie between two rows.
constexpr std::array<double, row_levels> passing_stake{infinity, 0.01, 0.06};

/// The area of the unit disc to the left of a line at a distance from its middle, less pi / 2.
class SegmentArea {
 public:
    SegmentArea() {
        for (std::size_t i = 0; i <= count; ++i) {
            const double t = static_cast<double>(i) / count;
            const double half = std::sqrt((1 - t) * (1 + t));
            nodes_[i] = {t * half + lane::atan2(t, half), 2 * half / count};
        }
    }

    /// @param distance from -1 to 1; off by 2e-6 at most, without a kink
    [[nodiscard]] double operator()(double distance) const noexcept {
        const double place = std::abs(distance) * count;
        const auto i = std::min(static_cast<std::int32_t>(place), static_cast<std::int32_t>(count) - 1);
        const double s = place - i;
        const Node& from = nodes_[static_cast<std::size_t>(i)];
        const Node& to = nodes_[static_cast<std::size_t>(i) + 1];
        const double rise = to.area - from.area;
        const double bend = 3 * rise - 2 * from.slope - to.slope;
        const double twist = from.slope + to.slope - 2 * rise;
        const double area = from.area + s * (from.slope + s * (bend + s * twist));
        return distance < 0 ? -area : area;
    }

 private:
    static constexpr std::size_t count = 1024;

    struct Node {
        double area, slope;  ///< the slope over one step
    };
    std::array<Node, count + 1> nodes_{};
};

const SegmentArea& segment_area() {
    static const SegmentArea area;
    return area;
}

/// The integral of k - 1 over pieces of surface one after the other.
class Excess {
 public:
    explicit Excess(const DiscQuery& query) : query_(query), per_unit_(1 / query.unit_m) {}

    /// @param per_slope how far along the piece the gap grows by as much
    void add(double length_m, double gap_low_m, double gap_high_m, double per_slope) {
        const double one_m = std::max(0.0, gap_low_m);
        const double other_m = std::max(0.0, gap_high_m);
        if (query_.mean == nullptr) {
            sum_ += length_m * (mean_factor(query_, one_m, other_m) - 1);
            return;
        }
        const double one = one_m * per_unit_;
        const double other = other_m * per_unit_;
        if (std::abs(other - one) < CurveMean::short_range) {
            const double middle = 0.5 * (one + other);
            if (middle != level_) {  // floors and ceilings are one height for many pieces
                level_ = middle;
                level_excess_ = query_.curve(middle) - 1;
            }
            sum_ += length_m * level_excess_;
            return;
        }
        const double before = std::abs(one - last_) < same ? last_integral_ : query_.mean->quick_integral_to(one);
        last_ = other;
        last_integral_ = query_.mean->quick_integral_to(other);
        sum_ += (last_integral_ - before) * (query_.unit_m * per_slope) - length_m;
    }

    /// The sum since the last time.
    [[nodiscard]] double taken() noexcept { return std::exchange(sum_, 0.0); }

 private:
    static constexpr double same = 1e-12;  ///< distance where one triangle ends and the next begins

    const DiscQuery& query_;
    double per_unit_;
    double sum_ = 0;
    double level_ = -1, level_excess_ = 0;
    double last_ = -1, last_integral_ = 0;
};

/// How much a sum over rows may be off, from how they differ from their neighbours. Midpoints of strips are off by 1/24
/// of the second difference where strips change smoothly, by up to 1/8 of it where their change breaks, and by up to
/// half the step where they jump: then two second differences of opposite signs follow each other. Breaks and jumps
/// are off either way, so that their squares add up.
/// @param deviations of the strips' integrals from the disc's mean times their areas, one after the other
double doubt_of(std::span<const double> deviations) {
    constexpr double of_smooth = 1.0 / 24;
    constexpr double of_break = 0.0625;
    constexpr double of_jump = 0.43;
    std::array<double, 2> before{};  // the last one first; there is nothing beyond the disc
    double last_bend = 0;
    double smooth = 0;
    double breaks = 0;
    double jumps = 0;
    const auto add = [&](double deviation) {
        const double bend = deviation - 2 * before[0] + before[1];
        smooth += bend;
        breaks += bend * bend;
        jumps += std::max(0.0, -bend * last_bend);
        last_bend = bend;
        before = {deviation, before[0]};
    };
    std::for_each(deviations.begin(), deviations.end(), add);
    add(0);
    add(0);
    return std::sqrt(of_smooth * of_smooth * smooth * smooth + of_break * of_break * breaks +
                     of_jump * of_jump * jumps);
}

/// More rows than these cross no disc.
constexpr std::size_t max_rows = 2 * RowLattice::rows_in_radius.back() + 4;

/// What the rows of one level say.
struct RowSum {
    double excess;  ///< of the average over 1
    double doubt;   ///< see doubt_of()
};

/// Empty where something is in the slab over or under the disc.
/// @param minds_passing whether the doubt is infinite where something may lie between two rows
std::optional<RowSum> sum_over(const DiscQuery& query, const SurfaceRows& rows, double u, double v,
                               bool minds_passing) {
    const RowLattice& lattice = rows.lattice();
    const double r = query.radius_m;
    const double spacing = lattice.spacing_m();
    const SegmentArea& area = segment_area();
    const std::int64_t first = lattice.row_before(v - r);
    const std::int64_t last = lattice.row_before(v + r);
    Excess excess(query);
    const bool may_be_blocked = rows.has_blocked();
    const bool may_be_passed = minds_passing && rows.has_passed_by();
    const double edge_before = (static_cast<double>(first) * spacing - v) / r;
    const double step = spacing / r;
    // Of the chord of which a strip is as large as what it has of the disc, over the area of the unit disc's strip.
    const double half_of_area = 0.5 * r * r / spacing;
    double area_before = -0.5 * pi;
    double sum = 0;
    std::array<double, max_rows> strips{};
    std::array<double, max_rows> integrals{};
    std::size_t count = 0;
    bool is_passing = false;
    for (std::int64_t row = first; row <= last; ++row) {
        const double edge = edge_before + static_cast<double>(row - first + 1) * step;
        const double area_here = area(std::clamp(edge, -1.0, 1.0));
        const double strip = area_here - area_before;
        area_before = area_here;
        const double half = half_of_area * strip;
        if (!(half > 0)) {
            continue;
        }
        if (may_be_blocked && rows.is_blocked(row, u - half, u + half)) {
            return {};
        }
        is_passing = is_passing || (may_be_passed && rows.is_passed_by(row, u - half, u + half));
        rows.visit(row, u - half, u + half, query.hub_m[2],
                   [&excess](double length, double gap_low, double gap_high, double per_slope) {
                       excess.add(length, gap_low, gap_high, per_slope);
                   });
        const double integral = excess.taken();
        sum += integral;
        strips[count] = strip;
        integrals[count++] = integral;
    }
    const double mean = sum / pi;  // of all strips, whose areas add up to pi
    for (std::size_t i = 0; i < count; ++i) {
        integrals[i] -= mean * strips[i];
    }
    const double share_of_disc = spacing / (pi * r * r);
    return RowSum{share_of_disc * sum,
                  is_passing ? infinity : share_of_disc * doubt_of(std::span(integrals).first(count))};
}

/// 0 up to `low`, 1 from `high` on, smooth between.
double ramp(double x, double low, double high) {
    if (x <= low) {
        return 0;
    }
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

std::optional<double> row_average(const DiscQuery& query, const RowColumns& columns) {
    const ChordFrame frame = RowLattice::frame(query.radius_m);
    const auto& [x, y, z] = query.hub_m;
    const double u = frame.u_of(x, y);
    const double v = frame.v_of(x, y);
    const double farthest_m = 1e8 * query.radius_m;
    if (!(std::abs(u) < farthest_m && std::abs(v) < farthest_m && std::abs(z) < farthest_m)) {
        return {};
    }
    const auto column = columns.at(u, v);
    const std::optional<Slab> slab = column->slab_around(z);
    if (!slab) {
        return {};
    }
    const auto stake_beyond = [&query](double gap_m) {
        return query.curve.largest_change_beyond(gap_m / query.unit_m);
    };
    double stake = infinity;
    if (slab->is_empty) {
        const double gap_m = query.side == Side::below ? z - slab->low_m : slab->high_m - z;
        if (gap_m == infinity) {
            return query.factor(infinity);
        }
        stake = stake_beyond(gap_m);
    }
    if (stake > low_stake[0]) {  // perhaps only beside the disc: what is there must not matter
        stake = stake_beyond(column->nearest_gap_m(query));
    }
    if (stake == 0) {
        return query.factor(infinity);
    }
    double excess = 0;
    double share = 1;  // of the present level and those after it
    for (int level = 0; level < row_levels; ++level) {
        const auto i = static_cast<std::size_t>(level);
        const double by_stake = ramp(stake, low_stake[i], 2 * low_stake[i]);  // of the levels after this one
        if (by_stake == 1) {
            continue;
        }
        const auto rows = columns.rows(*column, u, v, query.side, level, *slab);
        if (const std::optional<double> gap_m = rows->level_gap_m(z)) {
            return query.factor(*gap_m);
        }
        const std::optional<RowSum> sum = sum_over(query, *rows, u, v, stake > passing_stake[i]);
        if (!sum) {
            return {};
        }
        const bool is_last = level == row_levels - 1;
        if (is_last && share * sum->doubt > last_doubt) {
            return {};
        }
        const double next_share =
            is_last ? 0 : std::max(by_stake, ramp(sum->doubt, 0.5 * allowed_doubt, allowed_doubt));
        excess += share * (1 - next_share) * sum->excess;
        share *= next_share;
        if (share == 0) {
            break;
        }
    }
    return 1 + excess;
}

}  // namespace downwash
