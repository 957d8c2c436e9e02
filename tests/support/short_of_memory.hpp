#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <functional>

namespace downwash::test {

/// Whether a process can be kept short of memory: sanitizers reserve terabytes of addresses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool can_limit_memory = false;
#else
inline constexpr bool can_limit_memory = true;
#endif

/// Runs an action in a child process that may take so many more bytes of addresses, for half a minute at most. The
/// stack of a thread takes eight millions.
/// @return whether it ended with true
inline bool succeeds_with_memory_left(rlim_t bytes, const std::function<bool()>& action) {
    const pid_t child = fork();
    if (child == 0) {
        long pages = 0;
        if (std::FILE* const statm = std::fopen("/proc/self/statm", "r")) {
            static_cast<void>(std::fscanf(statm, "%ld", &pages));
            static_cast<void>(std::fclose(statm));
        }
        const rlim_t limit = static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + bytes;
        const rlimit limits{limit, limit};
        setrlimit(RLIMIT_AS, &limits);
        alarm(30);
        _exit(action() ? 0 : 1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace downwash::test
