#include "core/net/udp_socket.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/base/text/errno_text.h"
#include "core/net/datagram/datagram_control.h"
#include "core/net/mono_clock.h"
#include "core/net/system/bind_error.h"

namespace dance {
namespace {

constexpr int kWantedBuffer_bytes = 4 << 20;  // the system's limit caps it

// SO_RCVBUFFORCE exceeds rmem_max where permitted; else as much as the system gives.
void ask_for_big_buffers(int fd) {
  const int bytes = kWantedBuffer_bytes;
  if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0)
    setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  if (setsockopt(fd, SOL_SOCKET, SO_SNDBUFFORCE, &bytes, sizeof bytes) != 0)
    setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
}

// The kernel refuses such an address and one that a route prohibits with the same error. Only the
// first becomes possible with SO_BROADCAST.
bool is_broadcast(int fd, const sockaddr* to, socklen_t length) {
  const int on = 1;
  return setsockopt(fd, SOL_SOCKET, SO_BROADCAST, &on, sizeof on) == 0 &&
         ::connect(fd, to, length) == 0;
}

std::int64_t realtime_ns() {
  timespec t{};
  clock_gettime(CLOCK_REALTIME, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

}  // namespace

struct UdpSocket::Batches {
  struct Slot {
    std::span<std::uint8_t> bytes;
    sockaddr_storage address{};
    iovec vector{};
    alignas(cmsghdr) std::array<char, kControlBytes> control;
  };
  std::vector<std::uint8_t> memory;
  std::vector<Slot> in;
  std::vector<mmsghdr> in_headers;
  std::vector<Datagram> received;
  std::vector<Slot> out;
  std::vector<mmsghdr> out_headers;
  std::size_t queued = 0;
  std::size_t used_in;  // of the last receive(): the kernel wrote into these headers

  explicit Batches(const UdpRoom& room)
      : memory(2 * room.datagrams * room.bytes),
        in(room.datagrams),
        in_headers(room.datagrams),
        received(room.datagrams),
        out(room.datagrams),
        out_headers(room.datagrams),
        used_in(room.datagrams) {
    for (std::size_t i = 0; i < room.datagrams; ++i) {
      in[i].bytes = std::span(memory).subspan(2 * i * room.bytes, room.bytes);
      out[i].bytes = std::span(memory).subspan((2 * i + 1) * room.bytes, room.bytes);
    }
  }

  void make_ready() {
    for (std::size_t i = 0; i < used_in; ++i) {
      Slot& slot = in[i];
      slot.vector = {slot.bytes.data(), slot.bytes.size()};
      msghdr& header = in_headers[i].msg_hdr;
      header = {};
      header.msg_name = &slot.address;
      header.msg_namelen = sizeof slot.address;
      header.msg_iov = &slot.vector;
      header.msg_iovlen = 1;
      header.msg_control = slot.control.data();
      header.msg_controllen = slot.control.size();
    }
    used_in = 0;
  }
};

UdpSocket::UdpSocket(int fd, Address::Family family, bool connected, const UdpRoom& room)
    : fd_(fd), family_(family), connected_(connected), batches_(std::make_unique<Batches>(room)) {}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      family_(other.family_),
      connected_(other.connected_),
      batches_(std::move(other.batches_)),
      counters_(other.counters_) {}

UdpSocket& UdpSocket::operator=(UdpSocket&& other) noexcept {
  if (this == &other) return *this;
  close_now();
  fd_ = std::exchange(other.fd_, -1);
  family_ = other.family_;
  connected_ = other.connected_;
  batches_ = std::move(other.batches_);
  counters_ = other.counters_;
  return *this;
}

UdpSocket::~UdpSocket() { close_now(); }

void UdpSocket::close_now() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

Result<UdpSocket> UdpSocket::open(Address::Family family, bool connected, const UdpRoom& room) {
  const int domain = family == Address::Family::kIpv6 ? AF_INET6 : AF_INET;
  const int fd = ::socket(domain, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return fail("no UDP socket can be had: " + errno_text(errno));
  UdpSocket socket(fd, family, connected, room);
  const int off = 0;
  const int on = 1;
  if (domain == AF_INET6) setsockopt(fd, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  // Routers split what their next link cannot carry whole, down to 576 bytes. By default they drop
  // it and report that, and many networks drop the report too. IPv6 carries 1280 bytes everywhere.
  const int may_be_split = IP_PMTUDISC_DONT;
  setsockopt(fd, IPPROTO_IP, IP_MTU_DISCOVER, &may_be_split, sizeof may_be_split);
  setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  ask_for_big_buffers(fd);
  return socket;
}

Result<UdpSocket> UdpSocket::bind(const Address& local, const UdpRoom& room) {
  DANCE_ASSERT(local.is_set());
  auto socket = open(local.family(), false, room);
  if (!socket) return socket;
  if (auto bound = socket->bind_to(local); !bound) return tl::make_unexpected(bound.error());
  return socket;
}

Result<UdpSocket> UdpSocket::serve(const Address& local, const UdpRoom& room) {
  auto socket = bind(local, room);
  if (!socket) return socket;
  const int on = 1;
  const bool is_ipv6 = local.family() == Address::Family::kIpv6;
  if (setsockopt(socket->fd_, is_ipv6 ? IPPROTO_IPV6 : IPPROTO_IP,
                 is_ipv6 ? IPV6_RECVPKTINFO : IP_PKTINFO, &on, sizeof on) != 0)
    return fail("the system does not report where datagrams were sent to: " + errno_text(errno));
  return socket;
}

Result<void> UdpSocket::bind_to(const Address& local) {
  sockaddr_storage raw{};
  const socklen_t length = local.to_sockaddr(local.family(), raw);
  if (::bind(fd_, reinterpret_cast<const sockaddr*>(&raw), length) == 0) return {};
  return fail(bind_error(local, errno));
}

Result<UdpSocket> UdpSocket::join(const Address& group, const Address& interface,
                                  const UdpRoom& room) {
  DANCE_ASSERT(group.is_multicast());
  if (group.family() != Address::Family::kIpv4)
    return fail("group " + group.to_string() + " is of IPv6: choose a multicast group of IPv4");
  auto socket = open(group.family(), false, room);
  if (!socket) return socket;
  const int on = 1;
  setsockopt(socket->fd_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  // Bound to the group, it does not hear what is sent to the same port of this machine.
  if (auto bound = socket->bind_to(group); !bound) return tl::make_unexpected(bound.error());
  ip_mreq request{};
  std::memcpy(&request.imr_multiaddr, group.ip().data(), sizeof request.imr_multiaddr);
  if (interface.is_set())
    std::memcpy(&request.imr_interface, interface.ip().data(), sizeof request.imr_interface);
  if (setsockopt(socket->fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) == 0)
    return socket;
  const std::string cause = errno_text(errno);
  return fail("group " + group.to_string() + " cannot be joined" +
              (interface.is_set() ? " on the interface of " + interface.to_string() : "") + ": " +
              cause + "; name the address of an interface that `ip address` lists");
}

Result<UdpSocket> UdpSocket::connect(const Address& peer, const UdpRoom& room) {
  DANCE_ASSERT(peer.is_set());
  auto socket = open(peer.family(), true, room);
  if (!socket) return socket;
  sockaddr_storage raw{};
  const socklen_t length = peer.to_sockaddr(peer.family(), raw);
  const auto* to = reinterpret_cast<const sockaddr*>(&raw);
  if (::connect(socket->fd_, to, length) == 0) return socket;
  const int error = errno;
  if (error == EACCES && is_broadcast(socket->fd_, to, length))
    return fail(peer.to_string() +
                " is a broadcast address, which stands for all hosts of a network: name the "
                "address of one host");
  return fail("no way to " + peer.to_string() + ": " + errno_text(error) + "; check the network");
}

Address UdpSocket::local_address() const {
  sockaddr_storage raw{};
  socklen_t length = sizeof raw;
  getsockname(fd_, reinterpret_cast<sockaddr*>(&raw), &length);
  return Address::from_sockaddr(raw);
}

std::span<const UdpSocket::Datagram> UdpSocket::receive() {
  Batches& b = *batches_;
  b.make_ready();
  const int count =
      recvmmsg(fd_, b.in_headers.data(), static_cast<unsigned>(b.in.size()), MSG_DONTWAIT, nullptr);
  if (count < 0) {
    if (errno == ECONNREFUSED) ++counters_.refused;
    return {};
  }
  // Both clocks are read here, as time has passed since the turn began.
  const ClockReadings read{realtime_ns(), mono_now()};
  b.used_in = static_cast<std::size_t>(count);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    mmsghdr& header = b.in_headers[i];
    ++counters_.received;
    counters_.received_bytes += header.msg_len;
    if ((header.msg_hdr.msg_flags & MSG_TRUNC) != 0) {
      ++counters_.truncated;
      continue;
    }
    Datagram& datagram = b.received[kept++];
    datagram = {
        Address::from_sockaddr(b.in[i].address), {b.in[i].bytes.data(), header.msg_len}, read.mono};
    read_control(header.msg_hdr, read, datagram.from, datagram.received);
  }
  return {b.received.data(), kept};
}

void UdpSocket::send(const Address& to, std::span<const std::uint8_t> bytes) {
  Batches& b = *batches_;
  Batches::Slot& slot = b.out[b.queued];
  DANCE_ASSERT(bytes.size() <= slot.bytes.size(), bytes.size());
  const socklen_t length = connected_ ? 0 : to.to_sockaddr(family_, slot.address);
  if (!connected_ && length == 0) {
    ++counters_.send_failed;
    return;
  }
  std::memcpy(slot.bytes.data(), bytes.data(), bytes.size());
  slot.vector = {slot.bytes.data(), bytes.size()};
  msghdr& header = b.out_headers[b.queued].msg_hdr;
  header = {};
  header.msg_name = connected_ ? nullptr : &slot.address;
  header.msg_namelen = length;
  header.msg_iov = &slot.vector;
  header.msg_iovlen = 1;
  if (!connected_) set_source(to, family_, slot.control.data(), header);
  if (++b.queued == b.out.size()) flush();
}

void UdpSocket::flush() {
  Batches& b = *batches_;
  std::size_t at = 0;
  while (at < b.queued) {
    const int sent = sendmmsg(fd_, b.out_headers.data() + at, static_cast<unsigned>(b.queued - at),
                              MSG_DONTWAIT);
    if (sent <= 0) {  // the first of the rest was refused: it is lost, the others are tried
      count_send_error(errno);
      ++at;
      continue;
    }
    for (std::size_t i = at; i < at + static_cast<std::size_t>(sent); ++i) {
      ++counters_.sent;
      counters_.sent_bytes += b.out_headers[i].msg_hdr.msg_iov->iov_len;
    }
    at += static_cast<std::size_t>(sent);
  }
  b.queued = 0;
}

void UdpSocket::send_now(const Address& to, std::span<const std::uint8_t> bytes) {
  sockaddr_storage raw{};
  const socklen_t length = connected_ ? 0 : to.to_sockaddr(family_, raw);
  if (!connected_ && length == 0) {
    ++counters_.send_failed;
    return;
  }
  alignas(cmsghdr) std::array<char, kControlBytes> control{};
  iovec vector{const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
  msghdr header{};
  header.msg_name = connected_ ? nullptr : &raw;
  header.msg_namelen = length;
  header.msg_iov = &vector;
  header.msg_iovlen = 1;
  if (!connected_) set_source(to, family_, control.data(), header);
  ssize_t sent = sendmsg(fd_, &header, MSG_DONTWAIT);
  // sendmsg() reported a pending ICMP error of an earlier datagram instead of sending: try again.
  if (sent < 0 && errno == ECONNREFUSED) {
    ++counters_.refused;
    sent = sendmsg(fd_, &header, MSG_DONTWAIT);
  }
  if (sent < 0) {
    count_send_error(errno);
    return;
  }
  ++counters_.sent;
  counters_.sent_bytes += bytes.size();
}

void UdpSocket::count_send_error(int error) {
  ++(error == ECONNREFUSED ? counters_.refused : counters_.send_failed);
}

bool machine_has_ipv6() {
  const int fd = ::socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd >= 0) ::close(fd);
  return fd >= 0;
}

Result<std::uint16_t> free_loopback_port() {
  // Ports below the kernel's ephemeral range, starting at another one in each process: so the port
  // is still free when the program that it is for binds it.
  constexpr unsigned kFirst = 20'000, kPorts = 12'000, kPerProcess = 8;
  static std::atomic<unsigned> next = static_cast<unsigned>(::getpid()) * kPerProcess;
  for (unsigned tries = 0; tries < kPorts; ++tries) {
    const auto port = static_cast<std::uint16_t>(kFirst + next++ % kPorts);
    if (UdpSocket::bind(Address::loopback(port))) return port;
  }
  return fail("no UDP port of 127.0.0.1 from " + std::to_string(kFirst) + " on is free");
}

}  // namespace dance
