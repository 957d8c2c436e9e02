#include "downwash/cli/interruption.hpp"

#include <pthread.h>
#include <unistd.h>

#include <csignal>

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

static_assert(static_cast<int>(ExitCode::interrupted) == 128 + SIGINT);
static_assert(static_cast<int>(ExitCode::terminated) == 128 + SIGTERM);

}  // namespace

Interruption::Interruption() {
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
    int signal = 0;
    while (sigwait(&set, &signal) == 0 && !is_over_) {
        if (signal_ != 0) {
            _exit(code_of(signal));
        }
        signal_ = signal;
        stop_.request_stop();
    }
}

}  // namespace downwash::cli
