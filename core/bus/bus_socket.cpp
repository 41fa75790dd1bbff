#include "core/bus/bus_socket.h"

#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/printable.h"
#include "core/base/text/errno_text.h"
#include "core/bus/datagram.h"

namespace dance {
namespace {

// Room while the program is stalled: about 6,500 poses, 1.8 s of thirty dancers at 120 Hz.
constexpr int kReceiveBufferBytes = 4 << 20;

std::string reason(const std::string& call) { return call + ": " + errno_text(errno); }

bool set_option(int fd, int level, int option, int value) {
  return setsockopt(fd, level, option, &value, sizeof value) == 0;
}

sockaddr_in socket_address(const BusAddress& address) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(address.ip);
  to.sin_port = htons(static_cast<std::uint16_t>(address.port));
  return to;
}

// Joins the group on a device; index 0: on the device of the group's route. errno says why not.
bool join(int fd, std::uint32_t group, int device_index) {
  ip_mreqn membership{};
  membership.imr_multiaddr.s_addr = htonl(group);
  membership.imr_ifindex = device_index;
  return setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0 ||
         errno == EADDRINUSE;  // the same device again
}

// Whether a datagram was not sent because no usable device leads to the group.
bool is_without_route(int error) {
  return error == ENETUNREACH || error == EHOSTUNREACH || error == EACCES || error == EPERM ||
         error == ENETDOWN || error == ENODEV || error == EINVAL || error == EADDRNOTAVAIL;
}

void leave(int fd, std::uint32_t group, int device_index) {
  ip_mreqn membership{};
  membership.imr_multiaddr.s_addr = htonl(group);
  membership.imr_ifindex = device_index;
  setsockopt(fd, IPPROTO_IP, IP_DROP_MEMBERSHIP, &membership, sizeof membership);
}

constexpr std::size_t kMostJoined = 8;

std::string device_text(const MulticastWatch::State& network) {
  return network.device == 0 ? "no device" : printable(network.name);
}

// Describes a change of the network and its effect on a bus.
std::string change_line(const BusAddress& address, const MulticastWatch::State& before,
                        const MulticastWatch::State& now) {
  if (before.is_loopback_up && !now.is_loopback_up)
    return "the loopback device is down: programs of this machine are not connected until it is "
           "up; bring it up with: ip link set lo up";
  if (!before.is_loopback_up && now.is_loopback_up)
    return "the loopback device is up again: programs of this machine are connected";
  if (before.device == now.device) return "";
  const std::string change =
      "multicast has moved from " + device_text(before) + " to " + device_text(now);
  if (address.ttl == 0) return change + "; the dance on this machine goes on over lo";
  if (now.device == 0)
    return change + "; the dance on this machine goes on over lo, other hosts are not reached";
  return change + "; the bus follows";
}

// Asks for the largest buffer; a privileged program may exceed net.core.rmem_max.
void set_receive_buffer(int fd, int bytes) {
  if (!set_option(fd, SOL_SOCKET, SO_RCVBUFFORCE, bytes))
    set_option(fd, SOL_SOCKET, SO_RCVBUF, bytes);
}

}  // namespace

struct BusSocket::Buffers {
  static constexpr std::size_t kSlotBytes = 65'536;

  // Not initialised, so that memory which no datagram reaches is never resident.
  std::unique_ptr<std::uint8_t[]> bytes =
      std::make_unique_for_overwrite<std::uint8_t[]>(kBatch * kSlotBytes);
  std::array<iovec, kBatch> parts{};
  std::array<mmsghdr, kBatch> messages{};
  std::array<std::span<const std::uint8_t>, kBatch> received{};

  Buffers() {
    for (std::size_t i = 0; i < kBatch; ++i) {
      parts[i] = {bytes.get() + i * kSlotBytes, kSlotBytes};
      messages[i].msg_hdr.msg_iov = &parts[i];
      messages[i].msg_hdr.msg_iovlen = 1;
    }
  }
};

BusSocket::BusSocket(const BusAddress& address)
    : address_(address),
      filter_(address.ttl == 0 ? ChannelFilter::Reach::kThisMachine
                               : ChannelFilter::Reach::kNetwork),
      buffers_(std::make_unique<Buffers>()) {}

BusSocket::BusSocket(BusSocket&& other) noexcept
    : address_(std::move(other.address_)),
      filter_(std::move(other.filter_)),
      receive_fd_(std::exchange(other.receive_fd_, -1)),
      send_fd_(std::exchange(other.send_fd_, -1)),
      poll_fd_(std::exchange(other.poll_fd_, -1)),
      watch_(std::move(other.watch_)),
      network_(std::move(other.network_)),
      joined_(std::move(other.joined_)),
      sequence_(other.sequence_),
      buffers_(std::move(other.buffers_)) {}

BusSocket::~BusSocket() {
  for (const int fd : {poll_fd_, receive_fd_, send_fd_})
    if (fd >= 0) close(fd);
}

Result<BusSocket> BusSocket::open(const BusAddress& address) {
  BusSocket bus(address);
  bus.watch_ = MulticastWatch::open(address.ip);  // first, so that no change is missed
  if (auto opened = bus.open_receive(); !opened) return tl::make_unexpected(opened.error());
  if (auto opened = bus.open_send(); !opened) return tl::make_unexpected(opened.error());
  bus.open_watch();
  return bus;
}

Result<void> BusSocket::open_receive() {
  receive_fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (receive_fd_ < 0) return fail(reason("socket"));
  if (!loopback_is_up(receive_fd_))
    return fail("the loopback device is down; bring it up with: ip link set lo up");
  // Before bind(): from its first moment on the port the socket receives nothing unfiltered.
  if (!filter_.attach(receive_fd_))
    return fail(reason("socket filter") + "; allow more with: sysctl -w net.core.optmem_max=20480");
  if (!set_option(receive_fd_, SOL_SOCKET, SO_REUSEADDR, 1)) return fail(reason("SO_REUSEADDR"));
  set_receive_buffer(receive_fd_, address_.receive_buffer_bytes > 0 ? address_.receive_buffer_bytes
                                                                    : kReceiveBufferBytes);
  // Binds to the group, so that unicast datagrams are not received.
  const sockaddr_in local = socket_address(address_);
  if (bind(receive_fd_, reinterpret_cast<const sockaddr*>(&local), sizeof local) != 0)
    return fail(reason("port " + std::to_string(address_.port)) +
                "; end the program that uses it, or choose another port");
  if (!join(receive_fd_, address_.ip, kLoopbackIndex))
    return fail(reason("multicast on the loopback device"));
  // LCM's own programs send over the device of the multicast route. The kernel loops their messages
  // back there for members of the group on that device. IP_MULTICAST_ALL stays 1, its default.
  if (!join(receive_fd_, address_.ip, 0) && address_.ttl > 0)
    return fail(
        "this machine has no route for multicast, which ttl=" + std::to_string(address_.ttl) +
        " needs; add one with: ip route add 224.0.0.0/4 dev DEVICE, or use ttl=0");
  return {};
}

// Makes one descriptor of the socket's and the watch's: programs poll a single one.
void BusSocket::open_watch() {
  if (!watch_) return;
  network_ = watch_->state();
  join_device(network_.device);
  poll_fd_ = epoll_create1(EPOLL_CLOEXEC);
  for (const int fd : {receive_fd_, watch_->fd()}) {
    epoll_event event{};
    event.events = EPOLLIN;
    if (poll_fd_ < 0 || epoll_ctl(poll_fd_, EPOLL_CTL_ADD, fd, &event) == 0) continue;
    close(std::exchange(poll_fd_, -1));
  }
}

void BusSocket::join_device(int device) {
  if (device == 0 || device == kLoopbackIndex) return;
  std::erase(joined_, device);
  if (!join(receive_fd_, address_.ip, device)) return;
  joined_.push_back(device);
  if (joined_.size() <= kMostJoined) return;
  leave(receive_fd_, address_.ip, joined_.front());
  joined_.erase(joined_.begin());
}

std::string BusSocket::follow_network() {
  if (!watch_ || !watch_->drain()) return "";
  MulticastWatch::State now = watch_->state();
  join_device(now.device);
  const std::string line = change_line(address_, network_, now);
  network_ = std::move(now);
  return line;
}

Result<void> BusSocket::open_send() {
  send_fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (send_fd_ < 0) return fail(reason("socket"));
  // The kernel assigns a port at the first send; all that arrives there is dropped.
  if (!drop_everything(send_fd_)) return fail(reason("socket filter"));
  if (!set_option(send_fd_, IPPROTO_IP, IP_MULTICAST_TTL, address_.ttl))
    return fail(reason("IP_MULTICAST_TTL"));
  if (address_.ttl > 0) return {};
  ip_mreqn device{};
  device.imr_ifindex = kLoopbackIndex;
  if (setsockopt(send_fd_, IPPROTO_IP, IP_MULTICAST_IF, &device, sizeof device) != 0)
    return fail(reason("IP_MULTICAST_IF"));
  return {};
}

void BusSocket::want(std::string_view beginning) {
  filter_.want(beginning);
  // The shortest filter was attached at open(), and the attached one always leaves room for it.
  filter_.attach(receive_fd_);
}

std::span<const std::span<const std::uint8_t>> BusSocket::receive() {
  Buffers& b = *buffers_;
  const int count = recvmmsg(receive_fd_, b.messages.data(), kBatch, MSG_DONTWAIT, nullptr);
  const auto received = static_cast<std::size_t>(std::max(count, 0));
  for (std::size_t i = 0; i < received; ++i)
    b.received[i] = {static_cast<const std::uint8_t*>(b.parts[i].iov_base), b.messages[i].msg_len};
  return {b.received.data(), received};
}

bool BusSocket::send(std::string_view name, const void* data, std::size_t size) {
  if (!is_channel_name(name)) return false;
  DatagramHeader header(sequence_++, name);
  if (header.size + size > kMaxDatagramBytes) return false;
  std::array<iovec, 2> parts{iovec{header.bytes.data(), header.size},
                             iovec{const_cast<void*>(data), size}};
  sockaddr_in to = socket_address(address_);
  msghdr message{};
  message.msg_name = &to;
  message.msg_namelen = sizeof to;
  message.msg_iov = parts.data();
  message.msg_iovlen = parts.size();
  if (sendmsg(send_fd_, &message, MSG_DONTWAIT) >= 0) return true;
  if (address_.ttl == 0 || !is_without_route(errno)) return false;
  // No network at the moment: the programs of this machine are members of the group on loopback.
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(in_pktinfo))> control{};
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  cmsghdr* part = CMSG_FIRSTHDR(&message);
  part->cmsg_level = IPPROTO_IP;
  part->cmsg_type = IP_PKTINFO;
  part->cmsg_len = CMSG_LEN(sizeof(in_pktinfo));
  in_pktinfo device{};
  device.ipi_ifindex = kLoopbackIndex;
  std::memcpy(CMSG_DATA(part), &device, sizeof device);
  return sendmsg(send_fd_, &message, MSG_DONTWAIT) >= 0;
}

}  // namespace dance
