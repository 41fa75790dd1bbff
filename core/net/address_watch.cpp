#include "core/net/address_watch.h"

#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace dance {

std::unique_ptr<AddressWatch> AddressWatch::open() {
  const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (fd < 0) return nullptr;
  sockaddr_nl groups{};
  groups.nl_family = AF_NETLINK;
  // Links too: when a device goes down, the kernel removes its IPv4 routes without a report.
  groups.nl_groups =
      RTMGRP_LINK | RTMGRP_IPV4_IFADDR | RTMGRP_IPV6_IFADDR | RTMGRP_IPV4_ROUTE | RTMGRP_IPV6_ROUTE;
  if (bind(fd, reinterpret_cast<const sockaddr*>(&groups), sizeof groups) != 0) {
    close(fd);
    return nullptr;
  }
  return std::unique_ptr<AddressWatch>(new AddressWatch(fd));
}

AddressWatch::~AddressWatch() { close(fd_); }

bool AddressWatch::drain() {
  bool has_changed = false;
  // Only that something changed matters, not what; so it does too where reports overflowed
  // (ENOBUFS).
  constexpr int kMostAtOnce = 64;
  for (int i = 0; i < kMostAtOnce; ++i) {
    alignas(nlmsghdr) std::array<char, 8192> bytes;
    const ssize_t size = recv(fd_, bytes.data(), bytes.size(), MSG_TRUNC);
    if (size < 0 && errno != ENOBUFS) break;
    has_changed = true;
  }
  return has_changed;
}

}  // namespace dance
