#include "downwash/thrust_stand/thrust_stand.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/thrust_stand/stand_log.hpp"
#include "downwash/thrust_stand/stand_statistics.hpp"
#include "downwash/thrust_stand/stand_steps.hpp"

namespace downwash {
namespace {

using namespace thrust_stand;

/// Thrusts below this share of the greatest are hardly more than the stand's noise.
constexpr double least_share = 0.05;

class Analysis {
 public:
    explicit Analysis(const ThrustStandSettings& settings) : settings_(settings) {}

    void add(const std::string& name, const std::string& text) {
        StandLog log = parse_stand_log(text, name, settings_, stand_.remarks);
        const std::vector<Stretch> stretches = stretches_of(log);
        const std::vector<StandRow> found = measurements_of(log, stretches);
        log.facts.measurements = found.size();
        measurements_.insert(measurements_.end(), found.begin(), found.end());
        for (const StepLag& lag : lags_of(log, stretches)) {
            (lag.is_rise ? rises_s_ : falls_s_).push_back(lag.time_constant_s);
        }
        is_of_speed_ = is_of_speed_ || has_speed(log);
        stand_.files.push_back(std::move(log.facts));
    }

    ThrustStand result() {
        gather();
        add_limits();
        add_ratios();
        add_scatter();
        add_lag();
        return std::move(stand_);
    }

 private:
    /// Groups measurements by their throttle; without one each is a group.
    void gather() {
        for (const StandRow& row : measurements_) {
            greatest_n_ = std::max(greatest_n_, row[Quantity::thrust]);
        }
        if (!(greatest_n_ > 0)) {
            throw_input_error(stand_.files[0].file + ": no thrust is above 0");
        }
        std::size_t number = 0;
        for (const StandRow& row : measurements_) {
            const double throttle = row[Quantity::throttle];
            groups_[std::isfinite(throttle) ? std::pair(throttle, std::size_t{0}) : std::pair(0.0, ++number)].push_back(
                row[Quantity::thrust]);
            if (row[Quantity::thrust] >= least_share * greatest_n_) {
                strong_.push_back(row);
            }
        }
    }

    void add_limits() {
        stand_.min_thrust_n = greatest_n_;
        for (const auto& [throttle, thrusts] : groups_) {
            const double mean_n = mean_of(thrusts).value;
            stand_.max_thrust_n = std::max(stand_.max_thrust_n, mean_n);
            constexpr double turning = 0.005;  // of the greatest thrust: more than the drift of a load cell
            if (mean_n > turning * greatest_n_) {
                stand_.min_thrust_n = std::min(stand_.min_thrust_n, mean_n);
            }
        }
    }

    /// @param x, y of a measurement; those that are not finite do not count
    template <class X, class Y>
    std::vector<std::pair<double, double>> points(const X& x, const Y& y) const {
        std::vector<std::pair<double, double>> found;
        for (const StandRow& row : strong_) {
            const std::pair<double, double> point(x(row), y(row));
            if (std::isfinite(point.first) && std::isfinite(point.second) && point.first > 0) {
                found.push_back(point);
            }
        }
        return found;
    }

    void add_ratios() {
        const auto thrust = [](const StandRow& row) { return row[Quantity::thrust]; };
        const auto square = [](const StandRow& row) { return row[Quantity::speed] * row[Quantity::speed]; };
        const auto power_law = [](const StandRow& row) { return std::pow(row[Quantity::thrust], 1.5); };
        if (const auto found = points(square, thrust); !found.empty()) {
            stand_.thrust_coefficient_n_s2 = ratio_of(found);
            if (settings_.radius_m) {
                const double turn_rad = 2 * std::numbers::pi;
                stand_.thrust_number = stand_.thrust_coefficient_n_s2->value * turn_rad * turn_rad /
                                       (settings_.air_density_kg_m3 * std::pow(2 * *settings_.radius_m, 4));
            }
        }
        if (const auto found = points(thrust, [](const StandRow& row) { return row[Quantity::torque]; });
            !found.empty()) {
            stand_.torque_ratio_m = ratio_of(found);
        }
        if (const auto found = points(power_law, [](const StandRow& row) { return row[Quantity::power]; });
            !found.empty()) {
            add_power(found);
        }
    }

    /// @param found thrust^1.5 and power
    void add_power(const std::vector<std::pair<double, double>>& found) {
        const auto ratio = [](const std::pair<double, double>& point) { return point.second / point.first; };
        const auto [least, greatest] = std::ranges::minmax_element(found, {}, ratio);
        stand_.power_range = {ratio(*least), ratio(*greatest)};
        if (!settings_.hover_thrust_n) {
            stand_.power_coefficient_w_n1p5 = ratio_of(found);
            return;
        }
        const double wanted = std::pow(*settings_.hover_thrust_n, 1.5);
        auto sorted = found;
        std::ranges::sort(sorted);
        if (wanted < sorted.front().first || wanted > sorted.back().first) {
            throw_input_error("a hover at " + to_text(*settings_.hover_thrust_n, 4) +
                              " N was not measured: expected a thrust from " +
                              to_text(std::pow(sorted.front().first, 2.0 / 3.0), 4) + " to " +
                              to_text(std::pow(sorted.back().first, 2.0 / 3.0), 4) + " N");
        }
        // Measurements within a tenth of that thrust, or the two around it.
        std::vector<std::pair<double, double>> near;
        for (const auto& point : sorted) {
            constexpr double width = 0.15;  // of thrust^1.5
            if (std::abs(point.first - wanted) <= width * wanted) {
                near.push_back(point);
            }
        }
        if (near.empty()) {
            const auto above = std::ranges::lower_bound(sorted, wanted, {}, &std::pair<double, double>::first);
            near = {above == sorted.begin() ? *above : *(above - 1), *above};
        }
        stand_.power_coefficient_w_n1p5 = ratio_of(near);
    }

    void add_scatter() {
        std::vector<std::vector<double>> relative;
        for (const auto& [throttle, thrusts] : groups_) {
            const double mean_n = mean_of(thrusts).value;
            if (thrusts.size() < 2 || mean_n < least_share * greatest_n_) {
                continue;
            }
            relative.emplace_back();
            for (const double thrust_n : thrusts) {
                relative.back().push_back(thrust_n / mean_n);
            }
        }
        stand_.thrust_scatter = scatter_within(relative);
        if (!stand_.thrust_scatter) {
            stand_.remarks.emplace_back(
                "there are fewer than three repetitions at equal throttle: the scatter of thrust is not known");
        }
    }

    void add_lag() {
        if (rises_s_.empty() && falls_s_.empty()) {
            stand_.remarks.emplace_back(
                "there is no step of the throttle in a log with time: the lag is not known (rotors.time_constant_s)");
            return;
        }
        // The slower way counts: a robot has one lag for both.
        const double rise_s = rises_s_.empty() ? 0 : mean_of(rises_s_).value;
        const double fall_s = falls_s_.empty() ? 0 : mean_of(falls_s_).value;
        StandLag lag;
        lag.is_of_rise = rise_s >= fall_s;
        lag.is_of_speed = is_of_speed_;
        const std::vector<double>& slower_s = lag.is_of_rise ? rises_s_ : falls_s_;
        lag.time_constant_s = mean_of(slower_s);
        lag.steps = slower_s.size();
        lag.scatter_s = scatter_within({slower_s});
        stand_.lag = lag;
    }

    const ThrustStandSettings& settings_;
    ThrustStand stand_;
    std::vector<StandRow> measurements_, strong_;
    std::map<std::pair<double, std::size_t>, std::vector<double>> groups_;  ///< thrusts by their throttle
    std::vector<double> rises_s_, falls_s_;
    double greatest_n_ = 0;
    bool is_of_speed_ = false;
};

/// " # from 0.011 to 0.013" behind a value with an interval.
std::string interval_text(const StandEstimate& estimate) {
    return estimate.low ? ", 95 % interval " + to_text(*estimate.low, 4) + " to " + to_text(*estimate.high, 4) : "";
}

std::string line(const std::string& key, double value, const std::string& comment) {
    return key + ": " + to_text(value, 6) + "  # " + comment + "\n";
}

std::string scatter_line(const std::string& key, const StandScatter& scatter, const std::string& of) {
    return key + ": {sd: " + to_text(scatter.sd, 3) + "}  # " + of + ", 95 % interval " + to_text(scatter.low, 3) +
           " to " + to_text(scatter.high, 3) + "\n";
}

}  // namespace

ThrustStand parse_thrust_stand(const std::vector<std::pair<std::string, std::string>>& texts,
                               const ThrustStandSettings& settings) {
    Analysis analysis(settings);
    std::vector<KeyError> errors;
    for (const auto& [name, text] : texts) {
        try {
            analysis.add(name, text);
        } catch (const InputError& error) {
            errors.insert(errors.end(), error.errors().begin(), error.errors().end());
        }
    }
    throw_if_any(errors);
    return analysis.result();
}

ThrustStand read_thrust_stand(const std::vector<std::filesystem::path>& files, const ThrustStandSettings& settings) {
    constexpr std::size_t max_bytes = std::size_t{256} << 20U;
    std::vector<std::pair<std::string, std::string>> texts;
    texts.reserve(files.size());
    for (const std::filesystem::path& file : files) {
        texts.emplace_back(file.string(), naming(file, [&] { return read_whole_file(file, max_bytes); }));
    }
    return parse_thrust_stand(texts, settings);
}

std::string thrust_stand_yaml(const ThrustStand& stand) {
    const std::string names = joined(stand.files, ", ", [](const StandFile& file) {
        return excerpt(std::filesystem::path(file.file).filename().string());
    });
    std::string yaml = "# From " + names + " by `downwash robot thrust`: put it into a robot file.\nrotors:\n";
    yaml += line("  min_thrust_n", stand.min_thrust_n, "at the lowest throttle at which it turns");
    yaml += line("  max_thrust_n", stand.max_thrust_n, "the greatest mean at one throttle");
    if (stand.torque_ratio_m) {
        yaml += line("  torque_ratio_m", stand.torque_ratio_m->value,
                     "of robots in space" + interval_text(*stand.torque_ratio_m));
    }
    if (stand.thrust_coefficient_n_s2) {
        yaml += line("  thrust_coefficient_n_s2", stand.thrust_coefficient_n_s2->value,
                     "of robots in space" + interval_text(*stand.thrust_coefficient_n_s2));
    }
    if (stand.lag) {
        yaml += line("  time_constant_s", stand.lag->time_constant_s.value,
                     "mean of " + std::to_string(stand.lag->steps) + (stand.lag->is_of_rise ? " rises" : " falls") +
                         interval_text(stand.lag->time_constant_s));
    }
    if (stand.power_coefficient_w_n1p5) {
        yaml += line("  power_coefficient_w_n1p5", stand.power_coefficient_w_n1p5->value,
                     "measurements have " + to_text(stand.power_range->first, 4) + " to " +
                         to_text(stand.power_range->second, 4) + interval_text(*stand.power_coefficient_w_n1p5));
    }
    const bool has_lag_scatter = stand.lag && stand.lag->scatter_s;
    if (stand.thrust_scatter || has_lag_scatter) {
        yaml += "uncertainty:\n  vehicle:\n";
    }
    if (stand.thrust_scatter) {
        yaml += scatter_line("    rotor_thrust_scale", *stand.thrust_scatter, "of repetitions at equal throttle");
    }
    if (has_lag_scatter) {
        yaml += scatter_line("    rotor_time_constant_s", *stand.lag->scatter_s, "of steps");
    }
    return yaml;
}

}  // namespace downwash
