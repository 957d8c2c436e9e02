#include "downwash/cli/interruption.hpp"

#include <fmt/core.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <ctime>
#include <fstream>

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

timespec timespec_of(std::chrono::nanoseconds time) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time);
    return {static_cast<std::time_t>(seconds.count()), static_cast<long>((time - seconds).count())};
}

/// Resident memory of the process; 0 where the system does not tell.
std::uint64_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t all_pages = 0;
    std::uint64_t resident_pages = 0;
    statm >> all_pages >> resident_pages;
    return statm ? resident_pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

static_assert(static_cast<int>(ExitCode::interrupted) == 128 + SIGINT);
static_assert(static_cast<int>(ExitCode::terminated) == 128 + SIGTERM);

}  // namespace

Interruption::Interruption(const CommandLimits& limits) : memory_bytes_(limits.memory_bytes) {
    if (limits.wall_s) {
        constexpr double max_s = 1e9;  // thirty years
        deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                       std::chrono::duration<double>(std::min(*limits.wall_s, max_s)));
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

/// How long to wait for a signal before a look at the limits; empty: there are none.
std::optional<std::chrono::nanoseconds> Interruption::next_look() const {
    constexpr std::chrono::nanoseconds period = std::chrono::milliseconds(50);
    std::optional<std::chrono::nanoseconds> wait;
    if (deadline_) {
        wait = std::max(std::chrono::nanoseconds(0), std::chrono::nanoseconds(*deadline_ - Clock::now()));
    }
    if (memory_bytes_) {
        wait = std::min(wait.value_or(period), period);
    }
    return wait;
}

void Interruption::wait() {
    const sigset_t set = awaited_signals();
    while (!is_over_) {
        if (deadline_ && Clock::now() >= *deadline_) {
            end_by_limit("the wall time is over", "--wall-limit");
        } else if (memory_bytes_ && resident_bytes() > *memory_bytes_) {
            end_by_limit("the memory is used up", "--max-memory");
        }
        int signal = 0;
        if (const auto look = next_look()) {
            const timespec left = timespec_of(*look);
            signal = sigtimedwait(&set, nullptr, &left);
        } else {
            sigwait(&set, &signal);
        }
        if (signal > 0 && !is_over_) {
            end_by_signal(signal);
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

void Interruption::end_by_limit(const char* what, const char* option) {
    deadline_.reset();
    memory_bytes_.reset();
    if (!has_results_) {
        print_error(fmt::format("downwash: {}, and nothing is found yet: {} expects more\n", what, option));
        _exit(static_cast<int>(ExitCode::no_solution));
    }
    stop_.request_stop();
}

}  // namespace downwash::cli
