#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

#include "downwash/cli/exit_code.hpp"

namespace downwash::cli {

/// While it lives, the first SIGINT or SIGTERM requests a stop and a second one ends the program at once.
/// To be made before any other thread is started: threads inherit that these signals are blocked.
class Interruption {
 public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

    /// What the signal that requested the stop asks to exit with; ExitCode::done without one.
    [[nodiscard]] ExitCode code() const;

 private:
    void wait();

    std::stop_source stop_;
    std::atomic<int> signal_ = 0;
    std::atomic<bool> is_over_ = false;
    std::thread thread_;
};

}  // namespace downwash::cli
