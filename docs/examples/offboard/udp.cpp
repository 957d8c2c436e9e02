#include "udp.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace {

sockaddr_in loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

}  // namespace

UdpSocket::UdpSocket(int own, int other) : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const sockaddr_in here = loopback(own), there = loopback(other);
    if (descriptor_ < 0 || ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&here), sizeof(here)) != 0 ||
        ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&there), sizeof(there)) != 0) {
        const std::string why = std::strerror(errno);
        ::close(descriptor_);
        throw std::runtime_error("UDP port " + std::to_string(own) + ": " + why);
    }
}

UdpSocket::~UdpSocket() {
    ::close(descriptor_);
}

void UdpSocket::send(const std::string& datagram) const {
    static_cast<void>(::send(descriptor_, datagram.data(), datagram.size(), 0));
}

std::optional<std::string> UdpSocket::receive(double timeout_s) {
    constexpr std::size_t max_datagram = 65536;
    pollfd one{descriptor_, POLLIN, 0};
    if (::poll(&one, 1, static_cast<int>(std::ceil(1e3 * timeout_s))) <= 0) {
        return std::nullopt;
    }
    std::string datagram(max_datagram, '\0');
    const ssize_t bytes = ::recv(descriptor_, datagram.data(), datagram.size(), MSG_DONTWAIT);
    datagram.resize(bytes < 0 ? 0 : static_cast<std::size_t>(bytes));
    return datagram;
}
