#include "downwash/aeromap/layer_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "downwash/aeromap/change_bound.hpp"
#include "downwash/aeromap/factor_patches.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/grids/factor_grid.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash {
namespace {

class RowsBuilder {
 public:
    RowsBuilder(const LayerGrid& grid, std::size_t first, std::size_t last)
        : grid_(grid),
          radius_m_(grid.effect.rotor_radius_m()),
          min_clearance_m_(grid.effect.min_clearance_m()),
          first_(first),
          last_(last),
          patches_(grid, first) {
        rows_.flyability.resize((last - first) * grid.columns, CellFlyability::flyable);
        everywhere_.factor = [this](double x, double z) { return patches_.factor(x, z).all; };
        everywhere_.shortest_turn_m = shortest_turn_m(grid.effect);
        partly_ = everywhere_;
        partly_.is_forbidden_around = [this](double x, double z, double reach) {
            return is_forbidden_around(x, z, reach);
        };
    }

    CellRows build() {
        find_flyable();
        build_columns({0, grid_.columns});
        return std::move(rows_);
    }

    CellRows rebuild(const LayerBefore& before, ColumnRange& columns) {
        find_flyable();
        columns = not_as_before(before);
        build_columns(columns);
        return std::move(rows_);
    }

 private:
    void find_flyable() {
        if (grid_.effect.settings().enabled) {
            classify(0, grid_.columns, first_, last_);
            if (grid_.effect.settings().map && min_clearance_m_ >= 0) {
                ask_given_map();
            }
        }
    }

    /// The values of some columns, whose blocks of patches are theirs alone.
    void build_columns(const ColumnRange& columns) {
        if (grid_.effect.settings().enabled && std::isinf(everywhere_.shortest_turn_m)) {
            patches_.fit(columns, [this](std::size_t i, std::size_t k, std::size_t n) {
                return flyable_cells(i, first_ + k, n);
            });
        }
        for (std::size_t k = first_; k < last_; ++k) {
            for (std::size_t i = columns.first; i < columns.last; ++i) {
                add_cell(i, k);
            }
        }
    }

    /// Those that may have changed, and those where other cells are flyable, with all that change with them.
    [[nodiscard]] ColumnRange not_as_before(const LayerBefore& before) {
        ColumnRange columns = before.changed;
        for (std::size_t k = first_; k < last_; ++k) {
            for (std::size_t i = 0; i < grid_.columns; ++i) {
                if (flyability(i, k) != before.flyability[k * grid_.columns + i]) {
                    columns = {std::min(columns.first, i), std::max(columns.last, i + 1)};
                }
            }
        }
        const ColumnRange changing = FactorPatches::changing_with(columns);
        return {changing.first, std::min(grid_.columns, changing.last)};
    }

    [[nodiscard]] double x_at(std::size_t i) const { return grid_.x_low_m + static_cast<double>(i) * grid_.side_m; }
    [[nodiscard]] double z_at(std::size_t k) const { return grid_.z_low_m + static_cast<double>(k) * grid_.side_m; }
    [[nodiscard]] Vector3 hub(double x, double z) const { return grid_.plane.to_world(x, grid_.lateral_m, z); }
    [[nodiscard]] double clearance_m(double x, double z) const {
        return disc_clearance_m(grid_.effect.scene(), hub(x, z), radius_m_);
    }
    /// Whether the disc's clearance is at least the distance, as it always is when that is not above 0. Sooner known
    /// than the clearance itself.
    [[nodiscard]] bool is_clear(double x, double z, double distance_m) const {
        return distance_m <= 0 || disc_is_clear(grid_.effect.scene(), hub(x, z), radius_m_, distance_m);
    }
    CellFlyability& flyability(std::size_t i, std::size_t k) {
        return rows_.flyability[(k - first_) * grid_.columns + i];
    }

    /// Which cells are flyable from (i, k) to before (i + n, k + n).
    FactorPatches::Flyable flyable_cells(std::size_t i, std::size_t k, std::size_t n) {
        bool are_all = true;
        bool is_none = true;
        for (std::size_t row = k; row < std::min(last_, k + n); ++row) {
            for (std::size_t column = i; column < std::min(grid_.columns, i + n); ++column) {
                are_all = are_all && flyability(column, row) == CellFlyability::flyable;
                is_none = is_none && flyability(column, row) == CellFlyability::forbidden;
            }
        }
        return is_none   ? FactorPatches::Flyable::none
               : are_all ? FactorPatches::Flyable::all
                         : FactorPatches::Flyable::some;
    }

    /// In the cell of mixed flyability that is looked at. The clearance of its middle often tells.
    bool is_forbidden_around(double x, double z, double reach) const {
        const double dx = x - middle_.x_m;
        const double dz = z - middle_.z_m;
        const double away = std::sqrt(dx * dx + dz * dz) + clearance_slack_m;
        if (middle_.clearance_m + away + reach < min_clearance_m_) {
            return true;
        }
        return middle_.clearance_m - away + reach < min_clearance_m_ && !is_clear(x, z, min_clearance_m_ - reach);
    }

    /// Moving the disc by d changes its clearance by at most d: one place decides a whole block of cells when its
    /// clearance differs from the minimum by more than the block's half diagonal. Otherwise the block is halved.
    void classify(std::size_t i0, std::size_t i1, std::size_t k0, std::size_t k1) {
        throw_if_over(grid_.is_over);
        const double half_x = 0.5 * (x_at(i1) - x_at(i0));
        const double half_z = 0.5 * (z_at(k1) - z_at(k0));
        const double reach = std::sqrt(half_x * half_x + half_z * half_z) + clearance_slack_m;
        const auto is_clear_in_middle = [&](double distance_m) {
            return is_clear(x_at(i0) + half_x, z_at(k0) + half_z, distance_m);
        };
        CellFlyability verdict = CellFlyability::mixed;
        if (is_clear_in_middle(min_clearance_m_ + reach)) {
            verdict = CellFlyability::flyable;
        } else if (!is_clear_in_middle(min_clearance_m_ - reach)) {
            verdict = CellFlyability::forbidden;
        } else if (i1 - i0 > 1 || k1 - k0 > 1) {
            if (i1 - i0 >= k1 - k0) {
                const std::size_t middle = i0 + (i1 - i0) / 2;
                classify(i0, middle, k0, k1);
                classify(middle, i1, k0, k1);
            } else {
                const std::size_t middle = k0 + (k1 - k0) / 2;
                classify(i0, i1, k0, middle);
                classify(i0, i1, middle, k1);
            }
            return;
        }
        for (std::size_t k = k0; k < k1; ++k) {
            for (std::size_t i = i0; i < i1; ++i) {
                flyability(i, k) = verdict;
            }
        }
    }

    /// Cells that the scene leaves flyable need the exact test wherever a given map may forbid a part of them.
    void ask_given_map() {
        constexpr double slack_m = 1e-9;  // the nodes of map and grid often coincide
        for (std::size_t k = first_; k < last_; ++k) {
            for (std::size_t i = 0; i < grid_.columns; ++i) {
                const double x_low = x_at(i) - slack_m;
                const double x_high = x_at(i + 1) + slack_m;
                const double z_low = z_at(k) - slack_m;
                const double z_high = z_at(k + 1) + slack_m;
                const std::array<Vector3, 4> corners{hub(x_low, z_low), hub(x_high, z_low), hub(x_low, z_high),
                                                     hub(x_high, z_high)};
                if (flyability(i, k) == CellFlyability::flyable &&
                    !grid_.effect.settings().map->is_flyable_between(corners)) {
                    flyability(i, k) = CellFlyability::mixed;
                }
            }
        }
    }

    /// The box around the hubs in a cell.
    [[nodiscard]] BoundingBox hubs_in(const CellSquare& cell) const {
        return BoundingBox::around(hub(cell.x_low_m, cell.z_low_m),
                                   hub(cell.x_low_m + cell.side_m, cell.z_low_m + cell.side_m));
    }

    void add_cell(std::size_t i, std::size_t k) {
        const CellSquare cell{x_at(i), z_at(k), grid_.side_m};
        const CellFlyability flyable = flyability(i, k);
        if (flyable == CellFlyability::forbidden) {
            rows_.steps.push_back({});
            rows_.sides.push_back(CellSides::below);
            rows_.nodes.insert(rows_.nodes.end(), 4, 1.0F);
            return;
        }
        if (flyable == CellFlyability::mixed) {
            middle_ = {cell.x_low_m + 0.5 * cell.side_m, cell.z_low_m + 0.5 * cell.side_m, 0};
            middle_.clearance_m = clearance_m(middle_.x_m, middle_.z_m);
        }
        const CellField& field = flyable == CellFlyability::mixed ? partly_ : everywhere_;
        const SidedChange change = max_change(grid_.effect, hubs_in(cell));
        const CellSides sides = sides_of(change);
        CellSteps steps = is_quiet(grid_.effect, change) ? CellSteps{} : steps_for(cell, field);
        rows_.sides.push_back(sides);
        if (sides != CellSides::both) {
            rows_.steps.push_back(steps);
            append_nodes(cell, steps, field, rows_.nodes);
            return;
        }
        CellField from_above = field;
        from_above.factor = [this](double x, double z) { return patches_.factor(x, z).above; };
        const CellSteps above = steps_for(cell, from_above);
        steps = {std::max(steps.x, above.x), std::max(steps.z, above.z)};
        rows_.steps.push_back(steps);
        append_nodes(cell, steps, field, rows_.nodes);
        append_nodes(cell, steps, from_above, rows_.nodes);
    }

    const LayerGrid& grid_;
    double radius_m_;
    double min_clearance_m_;
    std::size_t first_, last_;
    CellField everywhere_, partly_;
    CellRows rows_;
    FactorPatches patches_;
    struct Middle {
        double x_m, z_m, clearance_m;
    };
    Middle middle_{};  ///< the middle of the present cell, when it is mixed
};

/// Largest |dK/d(z/R)| of one side from a distance on.
double steepest(const EffectCurve& curve, double from_radii) {
    constexpr double step = 1e-3;
    double largest = 0;
    if (curve.depends_on_wall()) {
        for (const double d_over_r : curve.effect().table->d_over_r()) {
            largest = std::max(largest, steepest(curve.at_wall(d_over_r), from_radii));
        }
    }
    double here = curve(from_radii);
    for (int j = 1; j <= 4000; ++j) {
        const double next = curve(from_radii + j * step);
        largest = std::max(largest, std::abs(next - here) / step);
        here = next;
    }
    return largest;
}

}  // namespace

CellRows build_rows(const LayerGrid& grid, std::size_t first, std::size_t last) {
    return RowsBuilder(grid, first, last).build();
}

CellRows rebuild_rows(const LayerGrid& grid, std::size_t first, std::size_t last, const LayerBefore& before,
                      ColumnRange& columns) {
    return RowsBuilder(grid, first, last).rebuild(before, columns);
}

double longest_cell_side_m(const DirectEffect& effect) {
    const double from_radii = std::max(0.0, effect.min_clearance_m()) / effect.rotor_radius_m();
    const double slope = std::max(steepest(effect.ground(), from_radii), steepest(effect.ceiling(), from_radii));
    // A kink of slope s per radius, halfway between two nodes h apart, is missed by s h / 4R.
    const double resolved_radii = max_steps * 4 * 0.004 / std::max(slope, 1e-3);
    return effect.rotor_radius_m() * std::clamp(resolved_radii, 0.02, 0.45);
}

double shortest_turn_m(const DirectEffect& effect) {
    constexpr double turn_radii = 0.08;  // of tables, fountains and walls
    if (const auto& map = effect.settings().map) {
        const double x_m = map->x().step_m();
        const double y_m = map->is_planar() ? x_m : map->y().step_m();
        return 0.5 * std::min({x_m, y_m, map->z().step_m()});
    }
    if (effect.is_of_walls()) {
        return turn_radii * effect.rotor_radius_m();
    }
    return effect.ground().falls_with_distance() && effect.ceiling().falls_with_distance()
               ? std::numeric_limits<double>::infinity()
               : turn_radii * effect.rotor_radius_m();
}

}  // namespace downwash
