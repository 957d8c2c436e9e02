#include "downwash/aeromap/layer_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "downwash/aeromap/cell_refinement.hpp"
#include "downwash/aeromap/change_bound.hpp"
#include "downwash/aeromap/factor_patches.hpp"
#include "downwash/aeromap/owned_block.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/grids/factor_grid.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash {
namespace {

constexpr std::size_t side_cells = MapBlock::side_cells;

}  // namespace

class StripBuilder::Impl {
 public:
    Impl(const LayerGrid& grid, std::size_t row)
        : grid_(grid),
          radius_m_(grid.effect.rotor_radius_m()),
          min_clearance_m_(grid.effect.min_clearance_m()),
          first_(row * side_cells),
          last_(std::min(first_ + side_cells, grid.rows)),
          flyability_((last_ - first_) * grid.columns, CellFlyability::flyable),
          is_known_((grid.columns + side_cells - 1) / side_cells, false),
          shortest_turn_m_(shortest_turn_m(grid.effect)),
          patches_(grid, first_, cells_that_parabolas_may_fit()) {
        everywhere_.factor = [this](double x, double z) { return patches_.factor(x, z).all; };
        everywhere_.shortest_turn_m = shortest_turn_m_;
        partly_ = everywhere_;
        partly_.is_forbidden_around = [this](double x, double z, double reach) {
            return is_forbidden_around(x, z, reach);
        };
    }

    void look_at_all() { look_at({0, grid_.columns}); }

    BlockFlyability flyability_of(std::size_t column) {
        BlockFlyability cells;
        cells.fill(CellFlyability::forbidden);
        const std::size_t first = column * side_cells;
        for (std::size_t k = first_; k < last_; ++k) {
            for (std::size_t i = first; i < std::min(first + side_cells, grid_.columns); ++i) {
                cells[MapBlock::cell_at(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k))] =
                    flyability(i, k);
            }
        }
        return cells;
    }

    std::shared_ptr<const MapBlock> block(std::size_t column) {
        block_ = std::make_shared<OwnedBlock>();
        const std::size_t first = column * side_cells;
        const std::size_t last = std::min(first + side_cells, grid_.columns);
        is_calm_ = is_calm(first, last);
        const MapCell* before = nullptr;
        for (std::size_t k = first_; k < last_; ++k) {
            for (std::size_t i = first; i < last; ++i) {
                before = add_cell(i, k, before);
            }
        }
        block_->seal();
        return std::exchange(block_, nullptr);
    }

 private:
    FactorPatches::FlyableCells cells_that_parabolas_may_fit() {
        if (!grid_.effect.settings().enabled || !std::isinf(shortest_turn_m_)) {
            return {};
        }
        return [this](std::size_t i, std::size_t k, std::size_t n) { return flyable_cells(i, k, n); };
    }

    /// Finds which cells of some whole blocks are flyable.
    void look_at(const ColumnRange& columns) {
        if (grid_.effect.settings().enabled) {
            wanted_ = columns;
            classify(0, grid_.columns, first_, last_);
            if (grid_.effect.settings().map && min_clearance_m_ >= 0) {
                ask_given_map(columns);
            }
        }
        std::fill(is_known_.begin() + static_cast<std::ptrdiff_t>(columns.first / side_cells),
                  is_known_.begin() + static_cast<std::ptrdiff_t>((columns.last + side_cells - 1) / side_cells), true);
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
    [[nodiscard]] std::size_t place_of(std::size_t i, std::size_t k) const { return (k - first_) * grid_.columns + i; }
    /// Found for a whole block when it is first asked for.
    [[nodiscard]] CellFlyability flyability(std::size_t i, std::size_t k) {
        if (!is_known_[i / side_cells]) {
            const std::size_t first = i / side_cells * side_cells;
            look_at({first, std::min(first + side_cells, grid_.columns)});
        }
        return flyability_[place_of(i, k)];
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
    /// clearance differs from the minimum by more than the block's half diagonal. Otherwise the block is halved, from
    /// the whole strip down to the cells of the wanted columns: what is found there is the same whatever is wanted.
    void classify(std::size_t i0, std::size_t i1, std::size_t k0, std::size_t k1) {
        if (i1 <= wanted_.first || i0 >= wanted_.last) {
            return;
        }
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
            for (std::size_t i = std::max(i0, wanted_.first); i < std::min(i1, wanted_.last); ++i) {
                flyability_[place_of(i, k)] = verdict;
            }
        }
    }

    /// Cells that the scene leaves flyable need the exact test wherever a given map may forbid a part of them.
    void ask_given_map(const ColumnRange& columns) {
        constexpr double slack_m = 1e-9;  // the nodes of map and grid often coincide
        for (std::size_t k = first_; k < last_; ++k) {
            for (std::size_t i = columns.first; i < columns.last; ++i) {
                const double x_low = x_at(i) - slack_m;
                const double x_high = x_at(i + 1) + slack_m;
                const double z_low = z_at(k) - slack_m;
                const double z_high = z_at(k + 1) + slack_m;
                const std::array<Vector3, 4> corners{hub(x_low, z_low), hub(x_high, z_low), hub(x_low, z_high),
                                                     hub(x_high, z_high)};
                CellFlyability& flyability = flyability_[place_of(i, k)];
                if (flyability == CellFlyability::flyable &&
                    !grid_.effect.settings().map->is_flyable_between(corners)) {
                    flyability = CellFlyability::mixed;
                }
            }
        }
    }

    /// The box around the hubs in a cell.
    [[nodiscard]] BoundingBox hubs_in(const CellSquare& cell) const {
        return BoundingBox::around(hub(cell.x_low_m, cell.z_low_m),
                                   hub(cell.x_low_m + cell.side_m, cell.z_low_m + cell.side_m));
    }

    /// Whether the cells of some columns are quiet, with the surfaces above mattering in none: what bounds K over all
    /// of them bounds it in each.
    [[nodiscard]] bool is_calm(std::size_t first, std::size_t last) const {
        constexpr double slack_m = 1e-9;
        const SidedChange change =
            max_change(grid_.effect, BoundingBox::around(hub(x_at(first) - slack_m, z_at(first_) - slack_m),
                                                         hub(x_at(last) + slack_m, z_at(last_) + slack_m)));
        return is_quiet(grid_.effect, change) && sides_of(change) == CellSides::below;
    }

    /// @param before the cell added last in this block; nullptr: none   @return the cell that was added
    const MapCell* add_cell(std::size_t i, std::size_t k, const MapCell* before) {
        const std::uint32_t number = MapBlock::cell_at(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k));
        const CellFlyability flyable = flyability(i, k);
        values_.clear();
        CellSteps steps;
        CellSides sides = CellSides::below;
        if (flyable == CellFlyability::forbidden) {
            values_.assign(4, 1.0F);
        } else {
            find_values({x_at(i), z_at(k), grid_.side_m}, flyable, steps, sides);
        }
        std::vector<float>& nodes = block_->values;
        const bool is_as_before =
            before != nullptr && before->steps_x == steps.x && before->steps_z == steps.z &&
            nodes.size() - before->first_node == values_.size() &&
            std::equal(values_.begin(), values_.end(), nodes.begin() + static_cast<std::ptrdiff_t>(before->first_node));
        MapCell& cell = block_->cells[number];
        cell = {is_as_before ? before->first_node : static_cast<std::uint32_t>(nodes.size()), steps.x, steps.z};
        block_->flyability[number] = flyable;
        block_->sides[number] = sides;
        if (!is_as_before) {
            nodes.insert(nodes.end(), values_.begin(), values_.end());
        }
        return &cell;
    }

    /// The division and the values of a cell in which somebody may fly.
    void find_values(const CellSquare& cell, CellFlyability flyable, CellSteps& steps, CellSides& sides) {
        if (flyable == CellFlyability::mixed) {
            middle_ = {cell.x_low_m + 0.5 * cell.side_m, cell.z_low_m + 0.5 * cell.side_m, 0};
            middle_.clearance_m = clearance_m(middle_.x_m, middle_.z_m);
        }
        const CellField& field = flyable == CellFlyability::mixed ? partly_ : everywhere_;
        if (is_calm_) {
            append_nodes(cell, steps, field, values_);
            return;
        }
        const SidedChange change = max_change(grid_.effect, hubs_in(cell));
        sides = sides_of(change);
        steps = is_quiet(grid_.effect, change) ? CellSteps{} : steps_for(cell, field);
        if (sides != CellSides::both) {
            append_nodes(cell, steps, field, values_);
            return;
        }
        CellField from_above = field;
        from_above.factor = [this](double x, double z) { return patches_.factor(x, z).above; };
        const CellSteps above = steps_for(cell, from_above);
        steps = {std::max(steps.x, above.x), std::max(steps.z, above.z)};
        append_nodes(cell, steps, field, values_);
        append_nodes(cell, steps, from_above, values_);
    }

    const LayerGrid& grid_;
    double radius_m_;
    double min_clearance_m_;
    std::size_t first_, last_;                ///< rows of cells, to before the last
    std::vector<CellFlyability> flyability_;  ///< of the cells of the strip, row by row, where it is known
    std::vector<bool> is_known_;              ///< of each block
    ColumnRange wanted_{};                    ///< where classify() looks
    double shortest_turn_m_;
    CellField everywhere_, partly_;
    FactorPatches patches_;
    std::shared_ptr<OwnedBlock> block_;  ///< the block that is being filled
    bool is_calm_ = false;               ///< is_calm() of its columns
    std::vector<float> values_;          ///< of the cell that is being added
    struct Middle {
        double x_m, z_m, clearance_m;
    };
    Middle middle_{};  ///< the middle of the present cell, when it is mixed
};

namespace {

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

StripBuilder::StripBuilder(const LayerGrid& grid, std::size_t row) : impl_(std::make_unique<Impl>(grid, row)) {}

StripBuilder::~StripBuilder() = default;

void StripBuilder::look_at_all() {
    impl_->look_at_all();
}

BlockFlyability StripBuilder::flyability_of(std::size_t column) {
    return impl_->flyability_of(column);
}

std::shared_ptr<const MapBlock> StripBuilder::block(std::size_t column) {
    return impl_->block(column);
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
