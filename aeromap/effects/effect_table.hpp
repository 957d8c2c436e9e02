#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/csv_facts.hpp"
#include "downwash/base/export.hpp"

namespace downwash {

/// Measured or computed K of a wide flat surface over zeta = z/R, or over (zeta, d/R) with a second distance d. What
/// has no formula enters this way: tilted rotors, ground beside a wall, fountains under tandem rotors
/// (docs/model.md 4.6). K below one is possible. Immutable and safe to share.
///
/// Between the nodes K is interpolated by monotone cubics (PCHIP), along d first, then along zeta: continuous, with
/// a continuous slope, and never outside the range of the surrounding nodes. Nearer than the first zeta the first value
/// holds. Beyond the last the increment K - 1 decays as (last zeta / zeta)^2, the far field of an image source
/// (**choice**: measurements end before the effect does). d is taken as the nearest that the table has.
class DOWNWASH_EXPORT EffectTable {
 public:
    /// @param z_over_r at least two distances in [0, 1000], each at least 1e-6 above the one before
    /// @param d_over_r the same in [0, 10000], or empty for a table over zeta alone
    /// @param factors K in [0, 100]; those of one zeta are adjacent, in the order of d_over_r
    /// @param csv how the file looks that it was read from, if any
    /// @throws InputError
    EffectTable(std::vector<double> z_over_r, std::vector<double> d_over_r, std::vector<double> factors,
                CsvFacts csv = {});

    [[nodiscard]] bool depends_on_d() const noexcept { return !d_over_r_.empty(); }
    [[nodiscard]] std::span<const double> z_over_r() const noexcept { return z_over_r_; }
    [[nodiscard]] std::span<const double> d_over_r() const noexcept { return d_over_r_; }
    /// K at the nodes; those of one zeta are adjacent.
    [[nodiscard]] std::span<const double> factors() const noexcept { return factors_; }
    /// How its file looks.
    [[nodiscard]] const CsvFacts& csv() const noexcept { return csv_; }

    /// K over zeta at one d. Cheap to make. The table must outlive it.
    class DOWNWASH_EXPORT Curve {
     public:
        /// @param z_over_r >= 0, infinite for no surface
        [[nodiscard]] double operator()(double z_over_r) const;

     private:
        friend EffectTable;
        Curve(const EffectTable& table, double d_over_r);
        [[nodiscard]] double node(std::size_t row) const;
        [[nodiscard]] double secant(std::size_t row, double left, double right) const;

        const EffectTable* table_;
        std::size_t column_ = 0;  ///< the interval of d; its ends contribute as follows
        double left_ = 1, right_ = 0, slope_left_ = 0, slope_right_ = 0;
    };

    /// @param d_over_r any number but NaN; ignored by a table over zeta alone
    [[nodiscard]] Curve at(double d_over_r = 0) const { return {*this, d_over_r}; }

    /// Upper bound of |K - 1| at `z_over_r` and beyond for any d. Exact at the nodes, elsewhere the bound of the node
    /// before.
    [[nodiscard]] double largest_change_beyond(double z_over_r) const;

    /// A distance beyond which K is below `factor` for any d: the row behind the last one that reaches it. 0 if none
    /// does, infinite if K never falls below it. @param factor >= 1
    [[nodiscard]] double distance_below(double factor) const;

 private:
    std::vector<double> z_over_r_, d_over_r_, factors_;
    std::vector<double> slopes_z_;  ///< dK/dzeta at the nodes; of a table over zeta alone
    std::vector<double> slopes_d_;  ///< dK/d(d/R) at the nodes; of a table over both
    std::vector<double> changes_;   ///< largest |K - 1| from a zeta on
    CsvFacts csv_;
};

/// SHA-256 of a table's distances and factors, down to the last bit, as 64 hexadecimal digits.
[[nodiscard]] DOWNWASH_EXPORT std::string digest_of(const EffectTable& table);

/// Reads a table from a CSV file in any dialect of CsvReader: a header `z_over_r,factor` or
/// `z_over_r,d_over_r,factor` (`thrust_ratio` is understood for `factor`), then a row for every combination of
/// distances, in any order. Other columns are ignored. At most 100000 rows and 16 MB.
/// @throws InputError with "file:line: what is wrong" for each error found
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const EffectTable> read_effect_table(const std::filesystem::path& file);

/// Reads a table from text; errors use `name` as the name of the file.
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const EffectTable> parse_effect_table(std::string_view text,
                                                                                    std::string_view name);

}  // namespace downwash
