#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// Numbers that a log recorded at rising times: `width` of them each time.
struct LogSeries {
    std::string source;       ///< where the log has them: "vehicle_attitude.q", "columns x, y, z"; empty without any
    std::size_t width = 0;    ///< numbers of a row
    std::vector<double> t_s;  ///< since the log's beginning, strictly rising
    std::vector<double> numbers;  ///< row after row, width * t_s.size() of them, all finite

    [[nodiscard]] bool empty() const noexcept { return t_s.empty(); }
    [[nodiscard]] std::size_t rows() const noexcept { return t_s.size(); }
    [[nodiscard]] std::span<const double> row(std::size_t i) const noexcept {
        return {numbers.data() + i * width, width};
    }
    /// Adds a row. @return false, and nothing is added: it is not later than the last row, or a number is not finite
    DOWNWASH_EXPORT bool add(double time_s, std::span<const double> row);
};

/// Where a moment is among the rows of a series.
struct LogPlace {
    std::size_t row = 0;  ///< the last one that is not later, or the first
    double share = 0;     ///< of the way to the next row, 0 to 1
};

/// Reads a series at rising times, between its rows linearly. It keeps its place: a pass over a series takes time in
/// its length alone. Times may also go back, which takes a search.
class DOWNWASH_EXPORT LogCursor {
 public:
    /// @param series must outlive this   @param max_gap_s rows that are farther apart have nothing between them
    explicit LogCursor(const LogSeries& series, double max_gap_s = 1) : series_(series), max_gap_s_(max_gap_s) {}

    /// Empty before the first row, behind the last and within a gap.
    [[nodiscard]] std::optional<LogPlace> place(double time_s);
    /// The number of a column at a place.
    [[nodiscard]] double number(const LogPlace& at, std::size_t column) const noexcept;

 private:
    const LogSeries& series_;
    double max_gap_s_;
    std::size_t row_ = 0;
};

}  // namespace downwash
