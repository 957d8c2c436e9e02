#pragma once

#include <optional>
#include <stdexcept>
#include <string>

/// Nobody at the other end, or nothing that can be understood.
class ConnectionLost : public std::runtime_error {
 public:
    using std::runtime_error::runtime_error;
};

/// A connection over a Unix domain socket that carries lines of text. Errors throw ConnectionLost.
class LineSocket {
 public:
    /// Waits for the other process to listen at a path.
    static LineSocket connect_to(const std::string& path, double timeout_s);
    /// Listens at a path, and waits for the other process to connect.
    static LineSocket accept_at(const std::string& path, double timeout_s);
    ~LineSocket();
    LineSocket(const LineSocket&) = delete;
    LineSocket& operator=(const LineSocket&) = delete;

    void send(const std::string& line) const;
    /// The next line; nothing if none comes in time. A time of 0 takes what has arrived already.
    std::optional<std::string> receive(double timeout_s);

 private:
    explicit LineSocket(int descriptor) : descriptor_(descriptor) {}

    int descriptor_;
    std::string arrived_;
};
