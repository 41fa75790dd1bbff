#include "core/net/tcp_socket.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/text/errno_text.h"
#include "core/net/system/bind_error.h"

namespace dance {
namespace {

bool tcp_wait_for(int fd, short what, Duration longest) {
  pollfd waited{fd, what, 0};
  return poll(&waited, 1, static_cast<int>(longest.count_ms())) > 0;
}

tl::unexpected<Error> tcp_failure(const Address& to, int reason) {
  return fail(to.to_string() + ": " + errno_text(reason));
}

bool is_passing(int reason) { return reason == EAGAIN || reason == EWOULDBLOCK || reason == EINTR; }

}  // namespace

Result<void> try_tcp_port(const Address& local) {
  sockaddr_storage raw{};
  const socklen_t size = local.to_sockaddr(local.family(), raw);
  const bool is_ipv6 = local.family() == Address::Family::kIpv6;
  const int fd = ::socket(is_ipv6 ? AF_INET6 : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return fail(bind_error(local, errno));
  const int on = 1;
  // Connections that have just ended must not keep the port from a server that restarts.
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (is_ipv6) ::setsockopt(fd, IPPROTO_IPV6, IPV6_V6ONLY, &on, sizeof on);
  int error = 0;
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&raw), size) != 0 || ::listen(fd, 1) != 0)
    error = errno;
  ::close(fd);
  if (error != 0) return fail(bind_error(local, error));
  return {};
}

Result<TcpSocket> TcpSocket::begin(const Address& to) {
  sockaddr_storage raw{};
  const socklen_t size = to.to_sockaddr(to.family(), raw);
  const int family = to.family() == Address::Family::kIpv6 ? AF_INET6 : AF_INET;
  TcpSocket made(::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (made.fd_ < 0) return tcp_failure(to, errno);
  const int on = 1;
  ::setsockopt(made.fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  if (::connect(made.fd_, reinterpret_cast<const sockaddr*>(&raw), size) == 0) return made;
  if (errno != EINPROGRESS) return tcp_failure(to, errno);
  return made;
}

Result<void> TcpSocket::finish(const Address& to) {
  int reason = 0;
  socklen_t length = sizeof reason;
  ::getsockopt(fd_, SOL_SOCKET, SO_ERROR, &reason, &length);
  if (reason != 0) return tcp_failure(to, reason);
  return {};
}

TcpSocket& TcpSocket::operator=(TcpSocket&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

TcpSocket::~TcpSocket() {
  if (fd_ >= 0) ::close(fd_);
}

std::optional<std::size_t> TcpSocket::read(std::span<std::uint8_t> into) {
  const ssize_t count = ::recv(fd_, into.data(), into.size(), 0);
  if (count > 0) return static_cast<std::size_t>(count);
  if (count < 0 && is_passing(errno)) return 0;
  return std::nullopt;
}

std::optional<std::size_t> TcpSocket::write(std::span<const std::uint8_t> from) {
  const ssize_t count = ::send(fd_, from.data(), from.size(), MSG_NOSIGNAL);
  if (count >= 0) return static_cast<std::size_t>(count);
  if (is_passing(errno)) return 0;
  return std::nullopt;
}

bool TcpSocket::wait_for_bytes(Duration longest) const {
  return tcp_wait_for(fd_, POLLIN, longest);
}
bool TcpSocket::wait_for_room(Duration longest) const {
  return tcp_wait_for(fd_, POLLOUT, longest);
}

}  // namespace dance
