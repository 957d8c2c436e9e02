#include "downwash/logs/log_series.hpp"

#include <cmath>

namespace downwash {

bool LogSeries::add(double time_s, std::span<const double> row) {
    if (!std::isfinite(time_s) || (!t_s.empty() && time_s <= t_s.back()) ||
        !std::ranges::all_of(row, [](double number) { return std::isfinite(number); })) {
        return false;
    }
    t_s.push_back(time_s);
    numbers.insert(numbers.end(), row.begin(), row.end());
    return true;
}

std::optional<LogPlace> LogCursor::place(double time_s) {
    const std::vector<double>& times = series_.t_s;
    if (times.empty() || !(time_s >= times.front() && time_s <= times.back())) {
        return std::nullopt;
    }
    constexpr std::size_t near = 8;
    if (times[row_] > time_s || (row_ + near < times.size() && times[row_ + near] <= time_s)) {
        row_ = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time_s) - times.begin()) - 1;
    }
    while (row_ + 1 < times.size() && times[row_ + 1] <= time_s) {
        ++row_;
    }
    if (times[row_] == time_s || row_ + 1 == times.size()) {
        return LogPlace{row_, 0};
    }
    const double gap_s = times[row_ + 1] - times[row_];
    return gap_s > max_gap_s_ ? std::nullopt : std::optional(LogPlace{row_, (time_s - times[row_]) / gap_s});
}

double LogCursor::number(const LogPlace& at, std::size_t column) const noexcept {
    const double here = series_.row(at.row)[column];
    return at.share == 0 ? here : here + at.share * (series_.row(at.row + 1)[column] - here);
}

}  // namespace downwash
