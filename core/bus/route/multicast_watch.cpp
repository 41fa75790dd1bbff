#include "core/bus/route/multicast_watch.h"

#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "core/bus/channel_filter.h"

namespace dance {
namespace {

int netlink_socket(std::uint32_t groups) {
  const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (fd < 0) return fd;
  sockaddr_nl local{};
  local.nl_family = AF_NETLINK;
  local.nl_groups = groups;
  if (bind(fd, reinterpret_cast<const sockaddr*>(&local), sizeof local) == 0) return fd;
  close(fd);
  return -1;
}

// The device in the kernel's answer to a route request; 0 where it is an error.
int device_of(const nlmsghdr& answer) {
  if (answer.nlmsg_type != RTM_NEWROUTE) return 0;
  int left = static_cast<int>(RTM_PAYLOAD(&answer));
  for (const rtattr* part = RTM_RTA(static_cast<const rtmsg*>(NLMSG_DATA(&answer)));
       RTA_OK(part, left); part = RTA_NEXT(part, left)) {
    if (part->rta_type != RTA_OIF || RTA_PAYLOAD(part) < sizeof(int)) continue;
    int device = 0;
    std::memcpy(&device, RTA_DATA(part), sizeof device);
    return device;
  }
  return 0;
}

// The kernel looks up the route as for a datagram: with all tables and rules, which VPNs use.
int device_to(std::uint32_t group, int netlink_fd) {
  struct {
    nlmsghdr header;
    rtmsg route;
    rtattr to;
    std::uint32_t address;
  } request{};
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = RTM_GETROUTE;
  request.header.nlmsg_flags = NLM_F_REQUEST;
  request.route.rtm_family = AF_INET;
  request.route.rtm_dst_len = 32;
  request.to.rta_type = RTA_DST;
  request.to.rta_len = RTA_LENGTH(sizeof request.address);
  request.address = htonl(group);
  alignas(nlmsghdr) std::array<char, 4096> bytes{};
  // The kernel has answered when send() returns.
  if (send(netlink_fd, &request, sizeof request, 0) != sizeof request) return 0;
  const ssize_t size = recv(netlink_fd, bytes.data(), bytes.size(), 0);
  const auto* answer = reinterpret_cast<const nlmsghdr*>(bytes.data());
  const bool is_whole = size > 0 && NLMSG_OK(answer, static_cast<std::uint32_t>(size));
  return is_whole ? device_of(*answer) : 0;
}

bool name_device(int fd, int index, ifreq& device) {
  device = {};
  device.ifr_ifindex = index;
  return ioctl(fd, SIOCGIFNAME, &device) == 0;
}

}  // namespace

bool loopback_is_up(int socket_fd) {
  ifreq device{};
  return name_device(socket_fd, kLoopbackIndex, device) &&
         ioctl(socket_fd, SIOCGIFFLAGS, &device) == 0 && (device.ifr_flags & IFF_UP) != 0;
}

std::unique_ptr<MulticastWatch> MulticastWatch::open(std::uint32_t group) {
  std::unique_ptr<MulticastWatch> watch(new MulticastWatch(group));
  // Links too: when a device goes down, the kernel removes its IPv4 routes without a report.
  watch->fd_ =
      netlink_socket(RTMGRP_LINK | RTMGRP_IPV4_IFADDR | RTMGRP_IPV4_ROUTE | RTMGRP_IPV4_RULE);
  watch->request_fd_ = netlink_socket(0);
  watch->device_fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool is_open = watch->fd_ >= 0 && watch->request_fd_ >= 0 && watch->device_fd_ >= 0;
  return is_open ? std::move(watch) : nullptr;
}

MulticastWatch::~MulticastWatch() {
  for (const int fd : {fd_, request_fd_, device_fd_})
    if (fd >= 0) close(fd);
}

bool MulticastWatch::drain() {
  bool has_changed = false;
  constexpr int kMostAtOnce = 64;
  for (int i = 0; i < kMostAtOnce; ++i) {
    char byte = 0;
    const ssize_t size = recv(fd_, &byte, sizeof byte, MSG_TRUNC | MSG_DONTWAIT);
    if (size < 0 && errno != ENOBUFS) break;  // ENOBUFS: more reports than had room
    has_changed = true;
  }
  return has_changed;
}

MulticastWatch::State MulticastWatch::state() const {
  State state;
  state.device = device_to(group_, request_fd_);
  ifreq device{};
  if (state.device > 0 && name_device(device_fd_, state.device, device))
    state.name.assign(device.ifr_name, strnlen(device.ifr_name, sizeof device.ifr_name));
  state.is_loopback_up = loopback_is_up(device_fd_);
  return state;
}

}  // namespace dance
