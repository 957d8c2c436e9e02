#pragma once

#include <chrono>
#include <string>

#include "downwash/planner/solve.hpp"

namespace downwash::cli {

/// Shows on standard error how a search or another long task proceeds. A terminal gets one line that is rewritten;
/// other outputs get log lines: of a search at most one per second, of a task one per tenth that is done, at most one
/// every five seconds.
class ProgressDisplay {
 public:
    explicit ProgressDisplay(bool is_quiet);
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    /// Logs a line.
    void say(const std::string& text);

    /// Shows the state of a search.
    void show(const Progress& progress);
    /// Shows the share of a task that is done, 0 to 1.
    void show(const std::string& task, double share);
    /// Takes away the line that is rewritten, before something else is printed.
    void clear();

 private:
    void show_live(const std::string& text);
    [[nodiscard]] std::string time_left(double share) const;

    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds search_period{1}, task_period{5};

    bool is_quiet_;
    bool is_live_;
    bool has_line_ = false;
    Clock::time_point next_log_ = Clock::now();
    Clock::time_point next_task_log_ = Clock::now() + task_period;
    std::string task_;
    Clock::time_point task_began_ = Clock::now();
    double logged_share_ = 0;  ///< share of the task that was logged last
};

}  // namespace downwash::cli
