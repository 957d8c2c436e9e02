#include "downwash/cli/interruption.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <ctime>

#include "downwash/cli/output.hpp"

namespace downwash::cli {
namespace {

sigset_t awaited_signals() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    return set;
}

int code_of(int signal) {
    return 128 + signal;
}

/// The time that is left; none where that is less.
timespec until(std::chrono::steady_clock::time_point deadline) {
    const auto left =
        std::max(std::chrono::nanoseconds(0), std::chrono::nanoseconds(deadline - std::chrono::steady_clock::now()));
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
    return {static_cast<std::time_t>(seconds.count()), static_cast<long>((left - seconds).count())};
}

static_assert(static_cast<int>(ExitCode::interrupted) == 128 + SIGINT);
static_assert(static_cast<int>(ExitCode::terminated) == 128 + SIGTERM);

}  // namespace

Interruption::Interruption(std::optional<double> wall_limit_s) {
    if (wall_limit_s) {
        constexpr double max_s = 1e9;  // thirty years
        deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                       std::chrono::duration<double>(std::min(*wall_limit_s, max_s)));
    }
    const sigset_t set = awaited_signals();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    thread_ = std::thread([this] { wait(); });
}

Interruption::~Interruption() {
    is_over_ = true;
    pthread_kill(thread_.native_handle(), SIGINT);
    thread_.join();
    const sigset_t set = awaited_signals();
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

ExitCode Interruption::code() const {
    return signal_ == 0 ? ExitCode::done : static_cast<ExitCode>(code_of(signal_));
}

void Interruption::wait() {
    const sigset_t set = awaited_signals();
    while (!is_over_) {
        int signal = 0;
        if (deadline_) {
            const timespec left = until(*deadline_);
            signal = sigtimedwait(&set, nullptr, &left);
        } else {
            sigwait(&set, &signal);
        }
        if (is_over_) {
            return;
        }
        if (signal > 0) {
            end_by_signal(signal);
        } else if (deadline_ && Clock::now() >= *deadline_) {
            end_by_limit();
        }
    }
}

void Interruption::end_by_signal(int signal) {
    if (!has_results_ || stop_.stop_requested()) {
        _exit(code_of(signal));
    }
    signal_ = signal;
    stop_.request_stop();
}

void Interruption::end_by_limit() {
    deadline_.reset();
    if (!has_results_) {
        print_error("downwash: the wall time is over, and nothing is found yet: --wall-limit expects more\n");
        _exit(static_cast<int>(ExitCode::no_solution));
    }
    stop_.request_stop();
}

}  // namespace downwash::cli
