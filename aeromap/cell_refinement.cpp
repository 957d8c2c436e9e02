#include "downwash/aeromap/cell_refinement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace downwash {
namespace {

constexpr double allowed_error = 0.0065;
/// Below this an interval is not looked into further: twice of it still leaves the other axis most of the allowance.
constexpr double negligible_error = 0.0025;
constexpr std::size_t levels = 10;  // 2^0 to 2^9 steps
static_assert(1 << (levels - 1) == max_steps);
/// Largest error seen of linear interpolation with 2^level steps.
using ErrorPerLevel = std::array<double, levels>;

/// Values at the ends and the middle of an interval.
using Values = std::array<double, 3>;

/// Estimate of the largest deviation from the straight line through the ends. The middle shows all of a bend, two
/// thirds of a kink at a quarter, and half of a kink at an end, where it hardly matters.
double deviation(const Values& v) {
    return 1.5 * std::abs(v[1] - 0.5 * (v[0] + v[2]));
}

/// Whether the curve could have bent one way before the middle and the other way after it.
bool may_hide_a_turn(const Values& v) {
    return std::abs(v[2] - v[0]) > 6 * negligible_error;
}

/// Finds the errors along one line by halving it where it is not straight, where they matter.
class LineProbe {
 public:
    /// @param value K along the line, from 0 to 1   @param shortest_turn longer stretches are looked into anyway
    /// @param is_forbidden whether a stretch of the line with this middle and half width does not matter
    template <class Value, class IsForbidden>
    static void run(double shortest_turn, Value&& value, IsForbidden&& is_forbidden, ErrorPerLevel& errors) {
        if (!is_forbidden(0.5, 0.5)) {
            LineProbe(shortest_turn, errors).descend({value(0), value(0.5), value(1)}, 0, 1, 0, value, is_forbidden);
        }
    }

 private:
    LineProbe(double shortest_turn, ErrorPerLevel& errors) : shortest_turn_(shortest_turn), errors_(errors) {}

    template <class Value, class IsForbidden>
    void descend(const Values& v, double low, double width, std::size_t level, Value& value,
                 IsForbidden& is_forbidden) {
        double error = deviation(v);
        const double half = 0.5 * width;
        const bool is_long = width > shortest_turn_;
        std::array<Values, 2> halves{{{v[0], 0, v[1]}, {v[1], 0, v[2]}}};
        std::array<bool, 2> do_matter{};
        if (is_long || error > negligible_error || may_hide_a_turn(v)) {
            chords_[level] = {low, width, v[0], v[2]};
            for (std::size_t i = 0; i < 2; ++i) {
                const double middle = low + (static_cast<double>(i) + 0.5) * half;
                do_matter[i] = !is_forbidden(middle, 0.5 * half);
                if (do_matter[i]) {
                    halves[i][1] = value(middle);
                    error = std::max(error, add(middle, halves[i][1], level));
                }
            }
        }
        const bool is_last = (!is_long && error <= negligible_error) || level + 1 == levels;
        for (std::size_t finer = level; finer < (is_last ? levels : level + 1); ++finer) {
            errors_[finer] = std::max(errors_[finer], error);
        }
        for (std::size_t i = 0; i < 2 && !is_last; ++i) {
            if (do_matter[i]) {
                descend(halves[i], low + static_cast<double>(i) * half, half, level + 1, value, is_forbidden);
            }
        }
    }

    /// Notes what the interpolation of this level and of all coarser ones misses at a point; returns that of this
    /// level.
    double add(double at, double value, std::size_t level) {
        double missed = 0;
        for (std::size_t coarser = 0; coarser <= level; ++coarser) {
            const auto& [low, width, first, last] = chords_[coarser];
            missed = std::abs(value - (first + (at - low) / width * (last - first)));
            errors_[coarser] = std::max(errors_[coarser], missed);
        }
        return missed;
    }

    /// The straight line through the ends of the stretch that is looked into on a level.
    struct Chord {
        double low, width;
        double first, last;  ///< values at its ends
    };

    double shortest_turn_;
    ErrorPerLevel& errors_;
    std::array<Chord, levels> chords_{};
};

/// The fewest nodes within the allowance; the smallest error when nothing is.
CellSteps cheapest(const ErrorPerLevel& along_x, const ErrorPerLevel& along_z) {
    CellSteps best{max_steps, max_steps};
    double best_error = along_x[levels - 1] + along_z[levels - 1];
    int best_nodes = (max_steps + 1) * (max_steps + 1);
    for (std::size_t i = 0; i < levels; ++i) {
        for (std::size_t k = 0; k < levels; ++k) {
            const double error = along_x[i] + along_z[k];
            const int nodes = ((1 << i) + 1) * ((1 << k) + 1);
            const bool is_allowed = error <= allowed_error;
            const bool was_allowed = best_error <= allowed_error;
            const bool is_cheaper = nodes < best_nodes;
            const bool is_better = is_allowed
                                       ? (!was_allowed || is_cheaper)
                                       : !was_allowed && (error < best_error || (error == best_error && is_cheaper));
            if (is_better) {
                best = {static_cast<std::uint16_t>(1 << i), static_cast<std::uint16_t>(1 << k)};
                best_error = error;
                best_nodes = nodes;
            }
        }
    }
    return best;
}

}  // namespace

CellSteps steps_for(const CellSquare& cell, const CellField& field) {
    const auto x_at = [&](double part) { return cell.x_low_m + part * cell.side_m; };
    const auto z_at = [&](double part) { return cell.z_low_m + part * cell.side_m; };
    const auto is_forbidden = [&](double x, double z, double half) {
        return field.is_forbidden_around && field.is_forbidden_around(x_at(x), z_at(z), half * cell.side_m);
    };
    ErrorPerLevel along_x{};
    ErrorPerLevel along_z{};
    const double shortest_turn = field.shortest_turn_m / cell.side_m;
    for (const double at : {0.0, 0.5, 1.0}) {
        LineProbe::run(
            shortest_turn, [&](double x) { return field.factor(x_at(x), z_at(at)); },
            [&](double x, double half) { return is_forbidden(x, at, half); }, along_x);
        LineProbe::run(
            shortest_turn, [&](double z) { return field.factor(x_at(at), z_at(z)); },
            [&](double z, double half) { return is_forbidden(at, z, half); }, along_z);
    }
    return cheapest(along_x, along_z);
}

void append_nodes(const CellSquare& cell, const CellSteps& steps, const CellField& field, std::vector<float>& nodes) {
    const double step_x_m = cell.side_m / steps.x;
    const double step_z_m = cell.side_m / steps.z;
    const double reach_m = std::sqrt(step_x_m * step_x_m + step_z_m * step_z_m);
    for (int k = 0; k <= steps.z; ++k) {
        for (int i = 0; i <= steps.x; ++i) {
            const double x = cell.x_low_m + cell.side_m * i / steps.x;
            const double z = cell.z_low_m + cell.side_m * k / steps.z;
            const bool is_forbidden = field.is_forbidden_around && field.is_forbidden_around(x, z, reach_m);
            nodes.push_back(is_forbidden ? 1.0F : static_cast<float>(field.factor(x, z)));
        }
    }
}

}  // namespace downwash
