#include "line_socket.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t longest_line = 1 << 20;
constexpr std::size_t most_unsent = 1 << 24;

sockaddr_un address_of(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof(address.sun_path)) {
        throw ConnectionLost("the socket's path is longer than a Unix domain socket may have: " + path);
    }
    path.copy(address.sun_path, path.size());
    return address;
}

int new_socket() {
    const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (descriptor < 0) {
        throw ConnectionLost(std::string("no socket: ") + std::strerror(errno));
    }
    return descriptor;
}

int milliseconds(double time_s) {
    return static_cast<int>(std::ceil(1e3 * time_s));
}

/// A time that runs out.
class Deadline {
 public:
    explicit Deadline(double timeout_s) : end_(Clock::now() + std::chrono::duration<double>(timeout_s)) {}
    [[nodiscard]] double left_s() const {
        return std::max(0.0, std::chrono::duration<double>(end_ - Clock::now()).count());
    }

 private:
    std::chrono::time_point<Clock, std::chrono::duration<double>> end_;
};

/// Whether somebody connects before the time is over.
bool is_called(int listener, double timeout_s) {
    pollfd one{listener, POLLIN, 0};
    return ::poll(&one, 1, milliseconds(timeout_s)) > 0;
}

}  // namespace

LineSocket LineSocket::connect_to(const std::string& path, double timeout_s) {
    const sockaddr_un address = address_of(path);
    const Deadline deadline(timeout_s);
    for (;;) {
        const int descriptor = new_socket();
        if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
            return LineSocket(descriptor);
        }
        const std::string why = std::strerror(errno);
        ::close(descriptor);
        if (deadline.left_s() <= 0) {
            throw ConnectionLost(std::string("no vehicle listens at ").append(path).append(": ").append(why));
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

LineSocket LineSocket::accept_at(const std::string& path, double timeout_s) {
    const sockaddr_un address = address_of(path);
    const int listener = new_socket();
    ::unlink(path.c_str());  // of a vehicle that was killed
    const bool listens = ::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 &&
                         ::listen(listener, 1) == 0;
    const std::string why = std::strerror(errno);
    const int descriptor = listens && is_called(listener, timeout_s) ? ::accept(listener, nullptr, nullptr) : -1;
    ::close(listener);
    if (listens) {
        ::unlink(path.c_str());
    }
    if (descriptor < 0) {
        throw ConnectionLost(listens ? "no mission planner connects" : "cannot listen at " + path + ": " + why);
    }
    return LineSocket(descriptor);
}

LineSocket::~LineSocket() {
    ::close(descriptor_);
}

void LineSocket::send(const std::string& line) {
    unsent_.append(line).append("\n");
    flush();
    if (unsent_.size() > most_unsent) {
        throw ConnectionLost("the other process does not read");
    }
}

void LineSocket::drain(double timeout_s) {
    const Deadline deadline(timeout_s);
    for (flush(); !unsent_.empty() && deadline.left_s() > 0; flush()) {
        pollfd one{descriptor_, POLLOUT, 0};
        ::poll(&one, 1, milliseconds(deadline.left_s()));
    }
}

void LineSocket::flush() {
    while (!unsent_.empty()) {
        const ssize_t bytes = ::send(descriptor_, unsent_.data(), unsent_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (bytes < 0 && errno == EAGAIN) {
            return;
        }
        if (bytes < 0 && errno != EINTR) {
            throw ConnectionLost(std::string("the connection is gone: ") + std::strerror(errno));
        }
        unsent_.erase(0, bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
    }
}

bool LineSocket::wait(double timeout_s) {
    flush();
    pollfd one{descriptor_, static_cast<short>(unsent_.empty() ? POLLIN : POLLIN | POLLOUT), 0};
    return ::poll(&one, 1, milliseconds(timeout_s)) > 0 && (one.revents & ~POLLOUT) != 0;
}

std::optional<std::string> LineSocket::receive(double timeout_s) {
    const Deadline deadline(timeout_s);
    for (;;) {
        if (const std::size_t length = arrived_.find('\n'); length != std::string::npos) {
            std::string line = arrived_.substr(0, length);
            arrived_.erase(0, length + 1);
            return line;
        }
        if (arrived_.size() > longest_line) {
            throw ConnectionLost("what arrives has no lines");
        }
        if (!wait(deadline.left_s())) {
            if (deadline.left_s() <= 0) {
                return std::nullopt;
            }
            continue;
        }
        char bytes[4096];
        const ssize_t count = ::recv(descriptor_, bytes, sizeof(bytes), 0);
        if (count == 0 || (count < 0 && errno != EINTR)) {
            throw ConnectionLost("the connection was closed");
        }
        arrived_.append(bytes, count > 0 ? static_cast<std::size_t>(count) : 0);
    }
}
