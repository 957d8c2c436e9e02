#pragma once

#include <chrono>
#include <string>

#include "downwash/planner/solve.hpp"

namespace downwash::cli {

/// Tells on standard error how a search or another long task goes: on a terminal in one line that is written anew,
/// elsewhere in log lines: of a search at most one a second, of a task one when another tenth of it is done, at most
/// every five seconds and none before.
class ProgressDisplay {
 public:
    explicit ProgressDisplay(bool is_quiet);
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    /// Says something once.
    void say(const std::string& text);

    /// How far a search is.
    void show(const Progress& progress);
    /// How much of a task is done, 0 to 1.
    void show(const std::string& task, double share);

 private:
    void show_live(const std::string& text);
    void clear_line();

    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds search_period{1}, task_period{5};

    bool is_quiet_;
    bool is_live_;
    bool has_line_ = false;
    Clock::time_point next_log_ = Clock::now();
    Clock::time_point next_task_log_ = Clock::now() + task_period;
    std::string task_;
    double logged_share_ = 0;  ///< of the task
};

}  // namespace downwash::cli
