#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

#include "downwash/cli/exit_code.hpp"

namespace downwash::cli {

/// During its lifetime the first SIGINT or SIGTERM requests a stop and a second one ends the program at once.
/// Create it before any other thread: threads inherit that these signals are blocked.
class Interruption {
 public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

    /// The exit code for the signal that requested the stop; ExitCode::done without one.
    [[nodiscard]] ExitCode code() const;

 private:
    void wait();

    std::stop_source stop_;
    std::atomic<int> signal_ = 0;
    std::atomic<bool> is_over_ = false;
    std::thread thread_;
};

}  // namespace downwash::cli
