#include "downwash/report/gnuplot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <memory>
#include <system_error>
#include <thread>

#include "downwash/base/text.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {
namespace {

std::string reason(int error) {
    return std::generic_category().message(error);
}

/// A file without a name, which disappears with its last user. Unlike pipes, three of them cannot block each other, and
/// a reader that ends early raises no signal.
class NamelessFile {
 public:
    NamelessFile() : file_(std::tmpfile(), &std::fclose) {
        if (!file_) {
            throw PictureError("no temporary file can be made for gnuplot: " + reason(errno));
        }
        fcntl(descriptor(), F_SETFD, FD_CLOEXEC);
    }

    [[nodiscard]] int descriptor() const { return fileno(file_.get()); }

    void fill(std::string_view content) const {
        if (std::fwrite(content.data(), 1, content.size(), file_.get()) != content.size() ||
            std::fflush(file_.get()) != 0) {
            throw PictureError("the temporary file for gnuplot cannot be written: " + reason(errno));
        }
        std::rewind(file_.get());
    }

    /// The whole content.
    [[nodiscard]] std::string content() const {
        std::rewind(file_.get());
        std::string content;
        char block[65536];
        while (const std::size_t count = std::fread(block, 1, sizeof block, file_.get())) {
            content.append(block, count);
        }
        return content;
    }

 private:
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// The start of a child process: three descriptors, default signals.
class SpawnSettings {
 public:
    SpawnSettings(int in, int out, int err) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_adddup2(&actions_, in, STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, out, STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, err, STDERR_FILENO);
        posix_spawnattr_init(&attributes_);
        sigset_t signals;
        sigemptyset(&signals);
        posix_spawnattr_setsigmask(&attributes_, &signals);
        sigaddset(&signals, SIGPIPE);
        posix_spawnattr_setsigdefault(&attributes_, &signals);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    ~SpawnSettings() {
        posix_spawn_file_actions_destroy(&actions_);
        posix_spawnattr_destroy(&attributes_);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;

    /// Starts gnuplot, as found in PATH.
    [[nodiscard]] pid_t start() const {
        char name[] = "gnuplot";
        char no_settings[] = "-d";
        char* arguments[] = {name, no_settings, nullptr};
        pid_t process = 0;
        if (const int error = posix_spawnp(&process, name, &actions_, &attributes_, arguments, environ)) {
            if (error == ENOENT || error == EACCES) {
                throw PictureError(
                    "gnuplot draws the pictures, and PATH does not contain it: install the Debian package "
                    "gnuplot-nox (apt-get install gnuplot-nox)");
            }
            throw PictureError("gnuplot cannot be started: " + reason(error));
        }
        return process;
    }

 private:
    posix_spawn_file_actions_t actions_{};
    posix_spawnattr_t attributes_{};
};

/// The status of a process that ended within the limit.
/// @throws PictureError, with the process ended, when it did not
int wait_for(pid_t process, std::chrono::milliseconds limit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    int status = 0;
    for (;;) {
        const pid_t ended = waitpid(process, &status, WNOHANG);
        // If the host program ignores SIGCHLD there is no status: only the output of gnuplot tells.
        if (ended == process || (ended < 0 && errno == ECHILD)) {
            return status;
        }
        if (std::chrono::steady_clock::now() >= end) {
            kill(process, SIGKILL);
            waitpid(process, &status, 0);
            throw PictureError("gnuplot was stopped: it took longer than " + std::to_string(limit.count() / 1000) +
                               " s; draw a narrower picture");
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

/// The last line of gnuplot's error output that is not empty.
std::string last_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) {
        text.pop_back();
    }
    return excerpt(text.substr(text.rfind('\n') + 1));  // rfind: npos + 1 is 0
}

}  // namespace

std::string run_gnuplot(std::string_view script, std::chrono::milliseconds limit) {
    const NamelessFile in, out, err;
    in.fill(script);
    const pid_t process = SpawnSettings(in.descriptor(), out.descriptor(), err.descriptor()).start();
    const int status = wait_for(process, limit);
    std::string written = out.content();
    if (status != 0 || written.empty()) {
        throw PictureError("gnuplot failed: " + last_line(err.content()) +
                           "; pictures need its terminals svg and pngcairo, as in the Debian package gnuplot-nox");
    }
    return written;
}

}  // namespace downwash
