#include "core/net/local/local_messages.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "core/net/local_address.h"

namespace dance {
namespace {

constexpr int kConnectionsPerTurn = 16;
constexpr int kMessagesPerTurn = 64;
constexpr Duration kAcceptLater = Duration::s(1);

int message_socket() { return ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0); }

// The user of the process that connected, as the kernel noted it then.
bool is_of_this_user(int fd) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return false;
  return peer.uid == ::geteuid() || peer.uid == 0;
}

}  // namespace

Result<std::unique_ptr<LocalMessageServer>> LocalMessageServer::open(const std::string& path,
                                                                     OnMessage on_message,
                                                                     Poller& poller) {
  // A sender removes sockets of programs that have ended, and a socket that is not listening yet
  // looks like one of those: this one gets its name when it listens.
  const std::string folder = folder_of(path);
  const std::string unnamed = folder + "/new-" + path.substr(folder.size() + 1);
  DANCE_TRY(const sockaddr_un address, unix_address(unnamed));
  if (auto made = make_private_folder(folder); !made) return tl::make_unexpected(made.error());
  const int fd = message_socket();
  if (fd < 0) return fail("no local socket can be had: " + errno_text(errno));
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(unnamed.c_str(), 0600) != 0 || ::listen(fd, kConnectionsPerTurn) != 0 ||
      ::rename(unnamed.c_str(), path.c_str()) != 0) {
    auto failure = fail("socket " + path + " cannot be had: " + errno_text(errno));
    ::unlink(unnamed.c_str());
    ::close(fd);
    return failure;
  }
  return std::unique_ptr<LocalMessageServer>(
      new LocalMessageServer(fd, path, std::move(on_message), poller));
}

LocalMessageServer::LocalMessageServer(int fd, std::string path, OnMessage on_message,
                                       Poller& poller)
    : poller_(poller), fd_(fd), path_(std::move(path)), on_message_(std::move(on_message)) {
  clients_.fill(-1);
  timer_ = poller_.add_timer(MonoTime(), [this](MonoTime) {
    if (!is_watched_) watch();
    return MonoTime();
  });
  watch();
}

LocalMessageServer::~LocalMessageServer() {
  poller_.remove_timer(timer_);
  if (is_watched_) poller_.unwatch(fd_);
  for (const int client : clients_) {
    if (client < 0) continue;
    poller_.unwatch(client);
    ::close(client);
  }
  ::unlink(path_.c_str());
  ::close(fd_);
}

void LocalMessageServer::watch() {
  poller_.watch(fd_, [this](MonoTime now) { accept_some(now); });
  is_watched_ = true;
}

void LocalMessageServer::accept_some(MonoTime now) {
  for (int i = 0; i < kConnectionsPerTurn; ++i) {
    const int fd = ::accept4(fd_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd >= 0) {
      take(fd);
      continue;
    }
    if (errno == ECONNABORTED || errno == EINTR) continue;
    if (errno == EAGAIN) return;
    // No descriptor is free: the poller would spin here.
    poller_.unwatch(fd_);
    is_watched_ = false;
    poller_.set_deadline(timer_, now + kAcceptLater);
    return;
  }
}

void LocalMessageServer::take(int fd) {
  if (!is_of_this_user(fd)) {
    ++counters_.refused_users;
    ::close(fd);
    return;
  }
  const auto free = std::find(clients_.begin(), clients_.end(), -1);
  if (free == clients_.end()) {
    ++counters_.refused_clients;
    ::close(fd);
    return;
  }
  *free = fd;
  poller_.watch(fd, [this, &client = *free](MonoTime now) { read(client, now); });
}

void LocalMessageServer::read(int& fd, MonoTime now) {
  std::array<std::uint8_t, kMostBytes> bytes;
  for (int i = 0; i < kMessagesPerTurn; ++i) {
    const ssize_t size = ::recv(fd, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_TRUNC);
    if (size > static_cast<ssize_t>(bytes.size())) {
      ++counters_.oversized;
    } else if (size > 0) {
      on_message_({bytes.data(), static_cast<std::size_t>(size)}, now);
    } else {
      if (size < 0 && errno == EINTR) continue;
      if (size < 0 && errno == EAGAIN) return;
      poller_.unwatch(fd);
      ::close(fd);
      fd = -1;
      return;
    }
  }
}

std::optional<LocalMessageSender> LocalMessageSender::connect(const std::string& path) {
  const auto address = unix_address(path);
  // A socket in another user's folder may belong to that user.
  if (!address || !is_private_folder(folder_of(path)) || !is_socket(path)) return std::nullopt;
  const int fd = message_socket();
  if (fd < 0) return std::nullopt;
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) == 0)
    return LocalMessageSender(fd);
  if (errno == ECONNREFUSED) ::unlink(path.c_str());
  ::close(fd);
  return std::nullopt;
}

LocalMessageSender::~LocalMessageSender() {
  if (fd_ >= 0) ::close(fd_);
}

LocalMessageSender::Sent LocalMessageSender::send(std::span<const std::uint8_t> head,
                                                  std::span<const std::uint8_t> body) {
  // sendmsg() reads the parts and writes none of them.
  std::array<iovec, 2> parts{{{const_cast<std::uint8_t*>(head.data()), head.size()},
                              {const_cast<std::uint8_t*>(body.data()), body.size()}}};
  msghdr message{};
  message.msg_iov = parts.data();
  message.msg_iovlen = parts.size();
  for (;;) {
    if (::sendmsg(fd_, &message, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0) return Sent::kSent;
    if (errno == EINTR) continue;
    return errno == EAGAIN || errno == ENOBUFS ? Sent::kFull : Sent::kGone;
  }
}

}  // namespace dance
