#include "bench/path/bare_hops.h"

#include <arpa/inet.h>
#include <lcm/lcm.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace dance {
namespace {

constexpr std::size_t kMaxDatagram = 2048;

std::string reason(const std::string& call) {
  std::array<char, 128> text{};
  return call + ": " + strerror_r(errno, text.data(), text.size());
}

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

// A socket bound to from_port (0: any) and, where to_port is not 0, connected to it. Negative:
// errno tells.
int open_socket(std::uint16_t from_port, std::uint16_t to_port) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in from = loopback(from_port);
  if (fd < 0 || bind(fd, reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0) return -1;
  const sockaddr_in to = loopback(to_port);
  if (to_port != 0 && connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    return -1;
  return fd;
}

sockaddr_in group(std::uint16_t port) {
  sockaddr_in address = loopback(port);
  address.sin_addr.s_addr = htonl(0xefff4c43);  // 239.255.76.67
  return address;
}

ip_mreqn on_loopback() {
  ip_mreqn membership{};
  membership.imr_multiaddr = group(0).sin_addr;
  membership.imr_address.s_addr = htonl(INADDR_LOOPBACK);
  return membership;
}

// Forwards each datagram of one socket to the other.
Error forward(int in, int out) {
  if (in < 0 || out < 0) return {reason("bare hop's socket")};
  std::array<std::uint8_t, kMaxDatagram> datagram;
  for (;;) {
    const ssize_t size = recv(in, datagram.data(), datagram.size(), 0);
    if (size < 0 && errno != EINTR) return {reason("bare hop's recv")};
    if (size > 0) {
      [[maybe_unused]] const auto sent =
          send(out, datagram.data(), static_cast<std::size_t>(size), 0);
    }
  }
}

void on_message(const lcm_recv_buf_t* message, const char*, void* to_fd) {
  // What cannot be sent shows as not delivered.
  [[maybe_unused]] const auto sent =
      send(*static_cast<int*>(to_fd), message->data, message->data_size, 0);
}

}  // namespace

Error forward_bus_to_udp(const std::string& bus_url, const std::string& channel,
                         std::uint16_t to_port) {
  int fd = open_socket(0, to_port);
  if (fd < 0) return {reason("bare hop's socket")};
  lcm_t* lcm = lcm_create(bus_url.c_str());
  if (!lcm || !lcm_subscribe(lcm, channel.c_str(), on_message, &fd))
    return {"bare hop: LCM could not open " + bus_url};
  while (lcm_handle(lcm) == 0) continue;
  return {"bare hop: LCM ended on " + bus_url};
}

int open_group_receiver(std::uint16_t port) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int is_shared = 1;
  const sockaddr_in from = group(port);
  const ip_mreqn membership = on_loopback();
  if (fd < 0 || setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &is_shared, sizeof is_shared) != 0 ||
      bind(fd, reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0 ||
      setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0)
    return -1;
  return fd;
}

int open_group_sender(std::uint16_t port) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in to = group(port);
  const ip_mreqn device = on_loopback();
  const int ttl = 0;
  if (fd < 0 || setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &device, sizeof device) != 0 ||
      setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl) != 0 ||
      connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    return -1;
  return fd;
}

Error forward_group_to_udp(std::uint16_t group_port, std::uint16_t to_port) {
  return forward(open_group_receiver(group_port), open_socket(0, to_port));
}

Error forward_udp_to_group(std::uint16_t from_port, std::uint16_t group_port) {
  return forward(open_socket(from_port, 0), open_group_sender(group_port));
}

Error forward_udp_to_udp(std::uint16_t from_port, std::uint16_t to_port) {
  return forward(open_socket(from_port, 0), open_socket(0, to_port));
}

Error forward_udp_to_bus(std::uint16_t from_port, const std::string& bus_url,
                         const std::string& channel) {
  const int in = open_socket(from_port, 0);
  if (in < 0) return {reason("bare hop's socket")};
  lcm_t* lcm = lcm_create(bus_url.c_str());
  if (!lcm) return {"bare hop: LCM could not open " + bus_url};
  std::array<std::uint8_t, kMaxDatagram> datagram;
  for (;;) {
    const ssize_t size = recv(in, datagram.data(), datagram.size(), 0);
    if (size < 0 && errno != EINTR) return {reason("bare hop's recv")};
    if (size > 0) lcm_publish(lcm, channel.c_str(), datagram.data(), static_cast<unsigned>(size));
  }
}

}  // namespace dance
