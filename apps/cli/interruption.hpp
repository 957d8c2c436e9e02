#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <thread>

#include "downwash/cli/exit_code.hpp"

namespace downwash::cli {

/// Resource limits of a command; empty: no limit.
struct CommandLimits {
    std::optional<double> wall_s = {};               ///< counts from the construction of an Interruption on
    std::optional<std::uint64_t> memory_bytes = {};  ///< resident memory of the process
};

/// During its lifetime SIGINT, SIGTERM and the command's limits end the program at once or, where there are results to
/// save, request a stop. After a stop was requested a signal always ends the program at once.
/// Create it before any other thread: threads inherit the signal mask.
class Interruption {
 public:
    explicit Interruption(const CommandLimits& limits = {});
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// From now on there is something to save.
    void expect_results() { has_results_ = true; }

    [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

    /// The exit code for the signal that requested the stop; ExitCode::done without one, also after a limit was
    /// reached.
    [[nodiscard]] ExitCode code() const;

 private:
    using Clock = std::chrono::steady_clock;

    void wait();
    [[nodiscard]] std::optional<std::chrono::nanoseconds> next_look() const;
    void end_by_limit(const char* what, const char* option);
    void end_by_signal(int signal);

    std::optional<Clock::time_point> deadline_;  ///< empty also after a limit was reached
    std::optional<std::uint64_t> memory_bytes_;  ///< likewise
    std::stop_source stop_;
    std::atomic<int> signal_ = 0;
    std::atomic<bool> has_results_ = false;
    std::atomic<bool> is_over_ = false;
    std::thread thread_;
};

}  // namespace downwash::cli
