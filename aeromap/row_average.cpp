#include "downwash/aeromap/row_average.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "downwash/aeromap/chord_envelope.hpp"
#include "downwash/base/lane_math.hpp"

namespace downwash {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = 3.14159265358979323846;

/// From half of this doubt on the next level takes over.
constexpr double allowed_doubt = 5e-4;
/// With more doubt at the last level the parts are taken one by one.
constexpr double last_doubt = 1e-3;
/// Where all surfaces over or under the disc change K by less, a level is enough; up to twice this it counts for less
/// and less.
constexpr std::array<double, row_levels> low_stake{0.001, 0.006, infinity, infinity};
/// Where they change K by more, nothing may lie between two rows.
constexpr std::array<double, row_levels> passing_stake{infinity, infinity, 0.025, 0.075};

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

    void add(double low_m, double high_m, double gap_low_m, double gap_high_m) {
        const double length_m = high_m - low_m;
        if (query_.mean == nullptr) {
            sum_ += length_m * (mean_factor(query_, gap_low_m, gap_high_m) - 1);
            return;
        }
        const double one = gap_low_m * per_unit_;
        const double other = gap_high_m * per_unit_;
        const double range = other - one;
        if (std::abs(range) < CurveMean::short_range) {
            const double middle = 0.5 * (one + other);
            if (middle != level_) {  // floors and ceilings are one height for many pieces
                level_ = middle;
                level_excess_ = query_.curve(middle) - 1;
            }
            sum_ += length_m * level_excess_;
            return;
        }
        const double before = std::abs(one - last_) < same ? last_integral_ : query_.mean->integral_to(one);
        last_ = other;
        last_integral_ = query_.mean->integral_to(other);
        sum_ += length_m * ((last_integral_ - before) / range - 1);
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

/// How much an average over rows may be off, from how they differ from their neighbours. Midpoints of strips are off by
/// 1/24 of the second difference where rows change smoothly, by up to 1/8 of it where their change breaks, and by up to
/// half the step where they jump: then two second differences of opposite signs follow each other. Breaks and jumps
/// are off either way, so that their squares add up.
class RowDoubt {
 public:
    /// @param mean,weight of the next row, each in any unit
    void add(double mean, double weight) noexcept {
        if (rows_ >= 2) {
            // The least weight, so that a row that has just begun counts for nothing.
            const double bend = std::min({weight, weights_[0], weights_[1]}) * (mean - 2 * means_[0] + means_[1]);
            smooth_ += bend;
            breaks_ += bend * bend;
            jumps_ += std::max(0.0, -bend * last_bend_);
            last_bend_ = bend;
        }
        means_ = {mean, means_[0]};
        weights_ = {weight, weights_[0]};
        ++rows_;
    }

    [[nodiscard]] double value() const noexcept {
        constexpr double of_smooth = 1.0 / 24;
        constexpr double of_break = 0.0625;
        constexpr double of_jump = 0.43;
        return std::sqrt(of_smooth * of_smooth * smooth_ * smooth_ + of_break * of_break * breaks_ +
                         of_jump * of_jump * jumps_);
    }

 private:
    int rows_ = 0;
    std::array<double, 2> means_{}, weights_{};  ///< of the rows before, the last one first
    double last_bend_ = 0;
    double smooth_ = 0, breaks_ = 0, jumps_ = 0;
};

/// What the rows of one level say.
struct RowSum {
    double excess;  ///< of the average over 1
    double doubt;   ///< see RowDoubt
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
    RowDoubt doubt;
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
                   [&excess](double low, double high, double gap_low, double gap_high) {
                       excess.add(low, high, gap_low, gap_high);
                   });
        const double integral = excess.taken();
        sum += integral;
        doubt.add(integral / half, strip);
    }
    const double share_of_disc = spacing / (pi * r * r);
    return RowSum{share_of_disc * sum, is_passing ? infinity : doubt.value() / (2 * pi)};
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
