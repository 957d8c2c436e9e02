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

    /// Never waits for the other process: what it does not take now is sent by later calls, of receive() too.
    void send(const std::string& line);
    /// Waits until all is sent, but no longer than that.
    void drain(double timeout_s);
    /// The next line; nothing if none comes in time. A time of 0 takes what has arrived already.
    std::optional<std::string> receive(double timeout_s);

 private:
    explicit LineSocket(int descriptor) : descriptor_(descriptor) {}

    void flush();
    /// Waits until there is something to read, or until something can be sent. @return whether there is to read
    bool wait(double timeout_s);

    int descriptor_;
    std::string arrived_, unsent_;
};
