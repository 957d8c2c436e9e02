#pragma once

#include <optional>
#include <string>

/// A UDP socket on the loopback that talks to one other. Errors of the system throw std::runtime_error.
class UdpSocket {
 public:
    /// @param own,other ports of 127.0.0.1
    UdpSocket(int own, int other);
    ~UdpSocket();
    UdpSocket(const UdpSocket&) = delete;
    UdpSocket& operator=(const UdpSocket&) = delete;

    /// What nobody listens to is lost.
    void send(const std::string& datagram) const;
    /// The next datagram, empty if nobody listens at the other port; nothing if none comes in time.
    std::optional<std::string> receive(double timeout_s);

 private:
    int descriptor_;
};
