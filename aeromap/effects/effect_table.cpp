#include "downwash/effects/effect_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "downwash/base/csv_reader.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/sha256.hpp"
#include "downwash/base/text.hpp"
#include "downwash/effects/effect_csv.hpp"
#include "downwash/effects/monotone_cubic.hpp"

namespace downwash {
namespace {

namespace mc = monotone_cubic;

constexpr double max_z_over_r = 1000;
constexpr double max_d_over_r = 10000;
constexpr double max_factor = 100;
constexpr double min_step = 1e-6;

bool is_in(double value, double low, double high) {
    return value >= low && value <= high;
}

void check_axis(const std::vector<double>& axis, const char* name, double max, std::vector<KeyError>& errors) {
    bool is_sound = axis.size() >= 2;
    for (std::size_t i = 0; i < axis.size(); ++i) {
        is_sound = is_sound && is_in(axis[i], 0, max) && (i == 0 || axis[i] - axis[i - 1] >= min_step);
    }
    if (!is_sound) {
        errors.push_back({name, "expected two or more numbers from 0 to " + to_text(max) +
                                    ", each at least 1e-6 above the one before"});
    }
}

/// Index of the interval of an axis that holds x, or of the one nearest to it.
std::size_t interval(const std::vector<double>& axis, double x) {
    const auto above = std::upper_bound(axis.begin() + 1, axis.end() - 1, x);
    return static_cast<std::size_t>(above - axis.begin()) - 1;
}

/// Slopes at the points of an axis whose values are `stride` apart in `values`, written likewise.
void fill_slopes(const std::vector<double>& axis, const double* values, double* slopes, std::size_t stride) {
    const std::size_t last = axis.size() - 1;
    double h_left = 0, secant_left = 0;
    for (std::size_t i = 0; i < last; ++i) {
        const double h = axis[i + 1] - axis[i];
        const double secant = (values[(i + 1) * stride] - values[i * stride]) / h;
        slopes[i * stride] = i == 0 ? secant : mc::slope(h_left, secant_left, h, secant);
        h_left = h;
        secant_left = secant;
    }
    slopes[last * stride] = secant_left;
}

}  // namespace

EffectTable::EffectTable(std::vector<double> z_over_r, std::vector<double> d_over_r, std::vector<double> factors,
                         CsvFacts csv)
    : z_over_r_(std::move(z_over_r)),
      d_over_r_(std::move(d_over_r)),
      factors_(std::move(factors)),
      csv_(std::move(csv)) {
    const std::size_t columns = depends_on_d() ? d_over_r_.size() : 1;
    std::vector<KeyError> errors;
    check_axis(z_over_r_, "z_over_r", max_z_over_r, errors);
    if (depends_on_d()) {
        check_axis(d_over_r_, "d_over_r", max_d_over_r, errors);
    }
    if (factors_.size() != z_over_r_.size() * columns ||
        !std::all_of(factors_.begin(), factors_.end(), [](double k) { return is_in(k, 0, max_factor); })) {
        errors.push_back({"factor", "expected a number from 0 to 100 for every combination of distances"});
    }
    throw_if_any(std::move(errors));

    if (depends_on_d()) {
        slopes_d_.resize(factors_.size());
        for (std::size_t row = 0; row < z_over_r_.size(); ++row) {
            fill_slopes(d_over_r_, &factors_[row * columns], &slopes_d_[row * columns], 1);
        }
    } else {
        slopes_z_.resize(factors_.size());
        fill_slopes(z_over_r_, factors_.data(), slopes_z_.data(), 1);
    }
    changes_.resize(z_over_r_.size());
    double largest = 0;
    for (std::size_t row = z_over_r_.size(); row-- > 0;) {
        for (std::size_t column = 0; column < columns; ++column) {
            largest = std::max(largest, std::abs(factors_[row * columns + column] - 1));
        }
        changes_[row] = largest;
    }
}

std::string digest_of(const EffectTable& table) {
    return sha256_hex(sha256_hex_of(table.z_over_r()) + sha256_hex_of(table.d_over_r()) +
                      sha256_hex_of(table.factors()));
}

double EffectTable::largest_change_beyond(double z_over_r) const {
    const double last = z_over_r_.back();
    if (z_over_r >= last) {
        return changes_.back() * (last / z_over_r) * (last / z_over_r);
    }
    return changes_[interval(z_over_r_, z_over_r)];
}

double EffectTable::distance_below(double factor) const {
    const auto last = std::find_if(factors_.rbegin(), factors_.rend(), [factor](double k) { return k >= factor; });
    if (last == factors_.rend()) {
        return 0;
    }
    const auto index = static_cast<std::size_t>(factors_.rend() - last) - 1;
    const std::size_t behind = index / (depends_on_d() ? d_over_r_.size() : 1) + 1;
    if (behind < z_over_r_.size()) {
        return z_over_r_[behind];
    }
    const double largest = *std::max_element(factors_.begin(), factors_.end());
    return factor > 1 ? z_over_r_.back() * std::sqrt((largest - 1) / (factor - 1))
                      : std::numeric_limits<double>::infinity();
}

EffectTable::Curve::Curve(const EffectTable& table, double d_over_r) : table_(&table) {
    const std::vector<double>& axis = table.d_over_r_;
    if (axis.empty()) {
        return;
    }
    const double d = lane::clamp(d_over_r, axis.front(), axis.back());
    column_ = interval(axis, d);
    const double h = axis[column_ + 1] - axis[column_];
    const mc::Weights weights = mc::weights(h, lane::min((d - axis[column_]) / h, 1.0));
    left_ = weights.left;
    right_ = weights.right;
    slope_left_ = weights.slope_left;
    slope_right_ = weights.slope_right;
}

/// K of a row at this d.
double EffectTable::Curve::node(std::size_t row) const {
    const std::size_t i = row * table_->d_over_r_.size() + column_;
    const std::vector<double>& k = table_->factors_;
    const std::vector<double>& slopes = table_->slopes_d_;
    return mc::value({left_, right_, slope_left_, slope_right_}, k[i], k[i + 1], slopes[i], slopes[i + 1]);
}

/// From a row to the next.
double EffectTable::Curve::secant(std::size_t row, double left, double right) const {
    return (right - left) / (table_->z_over_r_[row + 1] - table_->z_over_r_[row]);
}

double EffectTable::Curve::operator()(double z_over_r) const {
    const std::vector<double>& axis = table_->z_over_r_;
    const std::size_t last = axis.size() - 1;
    const bool is_plain = table_->slopes_d_.empty();
    const auto at = [&](std::size_t row) { return is_plain ? table_->factors_[row] : node(row); };
    if (z_over_r <= axis.front()) {
        return at(0);
    }
    if (z_over_r >= axis.back()) {
        const double ratio = axis.back() / z_over_r;
        return 1 + (at(last) - 1) * (ratio * ratio);
    }
    const std::size_t i = interval(axis, z_over_r);
    const double h = axis[i + 1] - axis[i];
    const mc::Weights weights = mc::weights(h, lane::min((z_over_r - axis[i]) / h, 1.0));
    const double left = at(i);
    const double right = at(i + 1);
    if (is_plain) {
        return mc::value(weights, left, right, table_->slopes_z_[i], table_->slopes_z_[i + 1]);
    }
    const double here = secant(i, left, right);
    const double slope_left = i == 0 ? here : mc::slope(axis[i] - axis[i - 1], secant(i - 1, at(i - 1), left), h, here);
    const double slope_right =
        i + 1 == last ? here : mc::slope(h, here, axis[i + 2] - axis[i + 1], secant(i + 1, right, at(i + 2)));
    return mc::value(weights, left, right, slope_left, slope_right);
}

namespace {

/// A row of a table's file.
struct Entry {
    double z_over_r, d_over_r, factor;
    std::size_t line;

    [[nodiscard]] auto key() const { return std::pair(z_over_r, d_over_r); }
};

std::string distance_text(const Entry& entry, bool has_d) {
    return "z_over_r " + to_text(entry.z_over_r) + (has_d ? ", d_over_r " + to_text(entry.d_over_r) : "");
}

/// The distinct values of an axis, sorted; errors for those that can hardly be told apart.
std::vector<double> axis_of(const std::vector<Entry>& entries, double Entry::*coordinate, const std::string& name,
                            LineErrors& errors) {
    std::vector<std::pair<double, std::size_t>> values;  // with the line of the first row that has it
    values.reserve(entries.size());
    for (const Entry& entry : entries) {
        values.emplace_back(entry.*coordinate, entry.line);
    }
    std::sort(values.begin(), values.end());
    std::vector<double> axis;
    for (const auto& [value, line] : values) {
        if (axis.empty() || value > axis.back()) {
            if (!axis.empty() && value - axis.back() < min_step) {
                errors.add(line, name + " " + to_text(value) + " is hardly above " + to_text(axis.back()) +
                                     ": expected steps of at least 1e-6, or exactly the same number");
            }
            axis.push_back(value);
        }
    }
    if (axis.size() < 2) {
        errors.add(0, name + " is " + to_text(axis.front()) + " in every row: expected two or more distances" +
                          (name == "d_over_r" ? ", or no such column" : ""));
    }
    return axis;
}

/// Errors of a grid with rows missing or there twice. Entries are sorted by their distances.
void check_grid(const std::vector<Entry>& entries, const std::vector<double>& z, const std::vector<double>& d,
                bool has_d, LineErrors& errors) {
    for (std::size_t i = 1; i < entries.size(); ++i) {
        if (entries[i].key() == entries[i - 1].key()) {
            errors.add(entries[i].line, distance_text(entries[i], has_d) + " is already in line " +
                                            std::to_string(entries[i - 1].line) +
                                            (has_d ? "" : "; a second distance is a column d_over_r"));
        }
    }
    errors.throw_any();
    std::size_t next = 0;
    for (const double z_over_r : z) {
        for (const double d_over_r : d) {
            const Entry expected{z_over_r, d_over_r, 0, 0};
            if (next < entries.size() && entries[next].key() == expected.key()) {
                ++next;
            } else {
                errors.add(0, "has no row for " + distance_text(expected, has_d) +
                                  ": expected one for every combination of distances");
                errors.throw_any();
            }
        }
    }
}

std::vector<Entry> entries_of(CsvReader& csv, LineErrors& errors) {
    const auto z = csv.find("z_over_r");
    const auto d = csv.find("d_over_r");
    const auto factor = csv.find("factor") ? csv.find("factor") : csv.find("thrust_ratio");
    if (!z || !factor) {
        errors.add(csv.header_line(), "has the columns '" + excerpt(joined(csv.names(), ", ")) +
                                          "': expected z_over_r,factor or z_over_r,d_over_r,factor" +
                                          csv.remedy_without({"z_over_r", factor ? "z_over_r" : "factor"}));
        errors.throw_any();
    }
    std::vector<Entry> entries;
    while (csv.next()) {
        const auto z_over_r = csv.number(*z, 0, max_z_over_r);
        const auto d_over_r = d ? csv.number(*d, 0, max_d_over_r) : std::optional(0.0);
        const auto k = csv.number(*factor, 0, max_factor);
        if (z_over_r && d_over_r && k) {
            entries.push_back({*z_over_r, *d_over_r, *k, csv.line()});
        }
    }
    errors.throw_any();
    if (entries.empty()) {
        errors.add(csv.header_line(), "no rows follow: expected a table of two or more distances");
    }
    errors.throw_any();
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return std::tuple(a.z_over_r, a.d_over_r, a.line) < std::tuple(b.z_over_r, b.d_over_r, b.line);
    });
    return entries;
}

}  // namespace

std::shared_ptr<const EffectTable> parse_effect_table(std::string_view text, std::string_view name) {
    LineErrors errors{std::string(name)};
    CsvReader csv(text, errors, effect_csv_limits);
    const std::vector<Entry> entries = entries_of(csv, errors);
    const bool has_d = csv.find("d_over_r").has_value();
    std::vector<double> z = axis_of(entries, &Entry::z_over_r, "z_over_r", errors);
    std::vector<double> d = has_d ? axis_of(entries, &Entry::d_over_r, "d_over_r", errors) : std::vector<double>{0};
    errors.throw_any();
    check_grid(entries, z, d, has_d, errors);
    std::vector<double> factors;
    factors.reserve(entries.size());
    for (const Entry& entry : entries) {
        factors.push_back(entry.factor);
    }
    return std::make_shared<const EffectTable>(std::move(z), has_d ? std::move(d) : std::vector<double>(),
                                               std::move(factors), csv.facts());
}

std::shared_ptr<const EffectTable> read_effect_table(const std::filesystem::path& file) {
    return parse_effect_table(read_effect_csv(file), file.string());
}

}  // namespace downwash
