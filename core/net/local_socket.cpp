#include "core/net/local_socket.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr int kAcceptsPerTurn = 16;
constexpr Duration kSendAgain = Duration::ms(5);
constexpr Duration kAcceptAgain = Duration::s(1);
constexpr std::size_t kLongestText_bytes = 64 << 20;

int connect_to(const sockaddr_un& address, int& error) {
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd >= 0 && ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
    return fd;
  error = errno;
  if (fd >= 0) ::close(fd);
  return -1;
}

}  // namespace

Result<std::unique_ptr<LocalTextServer>> LocalTextServer::open(const std::string& path,
                                                               MakeText make_text, Poller& poller) {
  DANCE_TRY(const sockaddr_un address, unix_address(path));
  if (auto made = make_private_folder(folder_of(path)); !made)
    return tl::make_unexpected(made.error());
  int error = 0;
  if (const int other = connect_to(address, error); other >= 0) {
    ::close(other);
    return fail("socket " + path + " is another server's");
  }
  // Left behind by a killed server; a file of another kind is not removed.
  if (error == ECONNREFUSED && is_socket(path)) ::unlink(path.c_str());
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return fail("no local socket can be had: " + errno_text(errno));
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(path.c_str(), 0600) != 0 || ::listen(fd, kAcceptsPerTurn) != 0) {
    auto failure = fail("socket " + path + " cannot be had: " + errno_text(errno));
    ::close(fd);
    return failure;
  }
  return std::unique_ptr<LocalTextServer>(
      new LocalTextServer(fd, path, std::move(make_text), poller));
}

LocalTextServer::LocalTextServer(int fd, std::string path, MakeText make_text, Poller& poller)
    : poller_(poller), fd_(fd), path_(std::move(path)), make_text_(std::move(make_text)) {
  timer_ = poller_.add_timer(MonoTime(), [this](MonoTime now) { return on_timer(now); });
  watch();
}

LocalTextServer::~LocalTextServer() {
  poller_.set_deadline(timer_, MonoTime());
  if (is_watched_) poller_.unwatch(fd_);
  for (Client& client : clients_)
    if (client.fd >= 0) ::close(client.fd);
  ::unlink(path_.c_str());
  ::close(fd_);
}

void LocalTextServer::watch() {
  poller_.watch(fd_, [this](MonoTime now) { on_readable(now); });
  is_watched_ = true;
}

std::size_t LocalTextServer::client_count() const {
  return static_cast<std::size_t>(
      std::count_if(clients_.begin(), clients_.end(), [](const auto& c) { return c.fd >= 0; }));
}

void LocalTextServer::on_readable(MonoTime now) {
  for (int i = 0; i < kAcceptsPerTurn; ++i) {
    const int fd = ::accept4(fd_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd >= 0) {
      accept_one(fd, now);
    } else if (errno == ECONNABORTED || errno == EINTR) {
      continue;
    } else {
      if (errno == EAGAIN) return;
      // No descriptor is free: the poller would spin here.
      poller_.unwatch(fd_);
      is_watched_ = false;
      poller_.set_deadline(timer_, now + kAcceptAgain);
      return;
    }
  }
}

void LocalTextServer::accept_one(int fd, MonoTime now) {
  const auto free =
      std::find_if(clients_.begin(), clients_.end(), [](const auto& c) { return c.fd < 0; });
  if (free == clients_.end()) {
    ++counters_.dropped;
    ::close(fd);
    return;
  }
  if (!text_ || now - text_made_ >= kTextStays) {
    text_ = std::make_shared<const std::string>(make_text_(now));
    text_made_ = now;
  }
  *free = {fd, text_, 0, now + kClientTimeout};
  send_on(*free, now);
  if (free->fd >= 0 && is_watched_) poller_.set_deadline(timer_, now + kSendAgain);
}

void LocalTextServer::send_on(Client& client, MonoTime now) {
  const std::string& text = *client.text;
  while (client.sent < text.size()) {
    const ssize_t n = ::send(client.fd, text.data() + client.sent, text.size() - client.sent,
                             MSG_DONTWAIT | MSG_NOSIGNAL);
    if (n > 0) {
      client.sent += static_cast<std::size_t>(n);
    } else if (n < 0 && errno == EINTR) {
      continue;
    } else {
      const bool waits = n < 0 && errno == EAGAIN && now < client.give_up;
      if (!waits) end(client, counters_.dropped);
      return;
    }
  }
  end(client, counters_.answered);
}

void LocalTextServer::end(Client& client, std::uint64_t& count) {
  ++count;
  ::close(client.fd);
  client = Client();
}

MonoTime LocalTextServer::on_timer(MonoTime now) {
  if (!is_watched_) watch();
  for (Client& client : clients_)
    if (client.fd >= 0) send_on(client, now);
  return client_count() > 0 ? now + kSendAgain : MonoTime();
}

tl::expected<std::string, LocalFailure> read_local_text(const std::string& path, Duration timeout) {
  const auto failed = [](LocalTrouble trouble, std::string reason) {
    return tl::make_unexpected(LocalFailure{trouble, std::move(reason)});
  };
  const auto address = unix_address(path);
  if (!address) return failed(LocalTrouble::kOther, address.error().what);
  int error = 0;
  const int fd = connect_to(*address, error);
  if (fd < 0) {
    if (error == ENOENT || error == ENOTDIR || error == ECONNREFUSED)
      return failed(LocalTrouble::kNobody, errno_text(error));
    if (error == EACCES || error == EPERM)
      return failed(LocalTrouble::kNotYours, errno_text(error));
    // The queue of connections is full.
    if (error == EAGAIN) return failed(LocalTrouble::kSilent, errno_text(error));
    return failed(LocalTrouble::kOther, errno_text(error));
  }
  const MonoTime give_up = mono_now() + timeout;
  std::string text;
  std::array<char, 65536> chunk;
  LocalFailure failure;
  for (;;) {
    const Duration left = give_up - mono_now();
    pollfd ready{fd, POLLIN, 0};
    if (left <= Duration() || ::poll(&ready, 1, static_cast<int>(left.count_ms()) + 1) == 0) {
      failure = {LocalTrouble::kSilent, "no answer"};
      break;
    }
    const ssize_t n = ::recv(fd, chunk.data(), chunk.size(), MSG_DONTWAIT);
    if (n == 0) {
      if (text.empty()) failure = {LocalTrouble::kSilent, "too many ask at a time"};
      break;
    }
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (n < 0 || text.size() > kLongestText_bytes) {
      failure = {LocalTrouble::kOther, n < 0 ? errno_text(errno) : "an endless answer"};
      break;
    }
    text.append(chunk.data(), static_cast<std::size_t>(n));
  }
  ::close(fd);
  if (!failure.reason.empty()) return tl::make_unexpected(std::move(failure));
  return text;
}

}  // namespace dance
