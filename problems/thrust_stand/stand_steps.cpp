#include "downwash/thrust_stand/stand_steps.hpp"

#include <algorithm>
#include <cmath>

namespace downwash::thrust_stand {
namespace {

std::size_t size_of(const Stretch& stretch) {
    return stretch.last - stretch.first;
}

/// Where its later half begins.
std::size_t middle_of(const Stretch& stretch) {
    return stretch.first + size_of(stretch) / 2;
}

/// A value for each row that goes as the thrust does.
std::vector<double> responses_of(const StandLog& log) {
    const bool is_of_speed = has_speed(log);
    std::vector<double> responses;
    for (const StandRow& row : log.rows) {
        responses.push_back(is_of_speed ? row[Quantity::speed] * row[Quantity::speed] : row[Quantity::thrust]);
    }
    return responses;
}

double mean_over(const std::vector<double>& values, std::size_t first, std::size_t last) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = first; i < last; ++i) {
        if (std::isfinite(values[i])) {
            sum += values[i];
            ++count;
        }
    }
    return sum / static_cast<double>(count);  // NaN without any
}

/// A step as a way from 1 to 0.
struct Way {
    std::vector<double> time_s, left;  ///< since the step, and the share of it that is left
};

/// The sum of squares that a time constant leaves.
double misfit(const Way& way, double time_constant_s) {
    double sum = 0;
    for (std::size_t i = 0; i < way.time_s.size(); ++i) {
        const double error = way.left[i] - std::exp(-way.time_s[i] / time_constant_s);
        sum += error * error;
    }
    return sum;
}

/// The time constant that fits best, by a search over orders of magnitude and then golden sections.
double fitted(const Way& way) {
    constexpr int tries = 60;
    constexpr double golden = 0.6180339887498949;
    const double span_s = way.time_s.back();
    const double low = std::log(span_s / static_cast<double>(way.time_s.size()) / 20), high = std::log(span_s);
    const double step = (high - low) / tries;
    const auto at = [&way](double logarithm) { return misfit(way, std::exp(logarithm)); };
    double best = low;
    for (int i = 1; i <= tries; ++i) {
        best = at(low + i * step) < at(best) ? low + i * step : best;
    }
    double from = best - step, to = best + step;
    while (to - from > 1e-6) {
        const double inner = to - golden * (to - from), outer = from + golden * (to - from);
        if (at(inner) < at(outer)) {
            to = outer;
        } else {
            from = inner;
        }
    }
    return std::exp(0.5 * (from + to));
}

}  // namespace

bool has_speed(const StandLog& log) {
    return std::ranges::any_of(log.rows, [](const StandRow& row) { return std::isfinite(row[Quantity::speed]); });
}

std::vector<Stretch> stretches_of(const StandLog& log) {
    const auto throttle = [&log](std::size_t i) { return log.rows[i][Quantity::throttle]; };
    std::vector<Stretch> stretches;
    for (std::size_t i = 0; i < log.rows.size(); ++i) {
        if (i > 0 && log.has_time && throttle(i) == throttle(i - 1)) {
            stretches.back().last = i + 1;
        } else {
            stretches.push_back({i, i + 1});
        }
    }
    return stretches;
}

std::vector<StandRow> measurements_of(const StandLog& log, const std::vector<Stretch>& stretches) {
    std::vector<StandRow> measurements;
    for (const Stretch& stretch : stretches) {
        StandRow mean;
        for (std::size_t k = 0; k < quantity_count; ++k) {
            const auto quantity = static_cast<Quantity>(k);
            double sum = 0;
            std::size_t count = 0;
            for (std::size_t i = middle_of(stretch); i < stretch.last; ++i) {
                if (const double value = log.rows[i][quantity]; std::isfinite(value)) {
                    sum += value;
                    ++count;
                }
            }
            if (count > 0) {
                mean[quantity] = sum / static_cast<double>(count);
            }
        }
        if (std::isfinite(mean[Quantity::thrust])) {
            measurements.push_back(mean);
        }
    }
    return measurements;
}

std::vector<StepLag> lags_of(const StandLog& log, const std::vector<Stretch>& stretches) {
    if (!log.has_time) {
        return {};
    }
    constexpr std::size_t least_rows = 6;
    constexpr double least_share = 0.1;
    const std::vector<double> responses = responses_of(log);
    double greatest = 0;
    for (const double response : responses) {
        greatest = std::isfinite(response) ? std::max(greatest, response) : greatest;
    }
    std::vector<StepLag> lags;
    for (std::size_t k = 1; k < stretches.size(); ++k) {
        const Stretch &before = stretches[k - 1], &here = stretches[k];
        if (size_of(before) < least_rows || size_of(here) < least_rows) {
            continue;
        }
        const double from = mean_over(responses, middle_of(before), before.last);
        const double to = mean_over(responses, middle_of(here), here.last);
        if (!(std::abs(to - from) >= least_share * greatest)) {
            continue;
        }
        Way way;
        for (std::size_t i = here.first; i < here.last; ++i) {
            const double time_s = log.rows[i][Quantity::time] - log.rows[here.first][Quantity::time];
            if (std::isfinite(responses[i]) && time_s >= 0) {
                way.time_s.push_back(time_s);
                way.left.push_back((responses[i] - to) / (from - to));
            }
        }
        if (way.time_s.size() >= least_rows && way.time_s.back() > 0) {
            lags.push_back({fitted(way), to > from});
        }
    }
    return lags;
}

}  // namespace downwash::thrust_stand
