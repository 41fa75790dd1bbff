#include "core/net/local_datagram.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/net/local_address.h"

namespace dance {
namespace {

int datagram_socket() { return ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0); }

// 0, or why not.
int connect_datagrams(int fd, const sockaddr_un& address) {
  return ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0
                                                                                         : errno;
}

}  // namespace

Result<std::unique_ptr<LocalDatagramSocket>> LocalDatagramSocket::bind(const std::string& path) {
  DANCE_TRY(const sockaddr_un address, unix_address(path));
  if (auto made = make_private_folder(folder_of(path)); !made)
    return tl::make_unexpected(made.error());
  const int fd = datagram_socket();
  if (fd < 0) return fail("no local socket can be had: " + errno_text(errno));
  const int error = connect_datagrams(fd, address);
  if (error == 0) {
    ::close(fd);
    return fail("socket " + path + " is another program's: end it, or choose another name");
  }
  // Left behind by a killed program; a file of another kind is not removed.
  if (error == ECONNREFUSED && is_socket(path)) ::unlink(path.c_str());
  struct stat made {};
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(path.c_str(), 0600) != 0 || ::lstat(path.c_str(), &made) != 0) {
    auto failure = fail("socket " + path + " cannot be had: " + errno_text(errno));
    ::close(fd);
    return failure;
  }
  return std::unique_ptr<LocalDatagramSocket>(new LocalDatagramSocket(fd, path, made));
}

bool LocalDatagramSocket::is_served(const std::string& path) {
  const auto address = unix_address(path);
  if (!address || !is_private_folder(folder_of(path)) || !is_socket(path)) return false;
  const int fd = datagram_socket();
  if (fd < 0) return true;  // not known: too many files
  const int error = connect_datagrams(fd, *address);
  ::close(fd);
  if (error == ECONNREFUSED) ::unlink(path.c_str());
  return error == 0;
}

LocalDatagramSocket::~LocalDatagramSocket() {
  struct stat found {};
  if (::lstat(path_.c_str(), &found) == 0 && found.st_ino == inode_ && found.st_dev == device_)
    ::unlink(path_.c_str());
  ::close(fd_);
}

std::ptrdiff_t LocalDatagramSocket::receive(std::span<std::uint8_t> buffer) {
  for (;;) {
    const ssize_t n = ::recv(fd_, buffer.data(), buffer.size(), MSG_DONTWAIT | MSG_TRUNC);
    if (n >= 0 || errno != EINTR) return n;
  }
}

Result<std::unique_ptr<LocalDatagramSender>> LocalDatagramSender::open(const std::string& path) {
  DANCE_TRY(const sockaddr_un address, unix_address(path));
  return std::unique_ptr<LocalDatagramSender>(new LocalDatagramSender(address, folder_of(path)));
}

LocalDatagramSender::~LocalDatagramSender() { disconnect(); }

void LocalDatagramSender::disconnect() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

bool LocalDatagramSender::connect(MonoTime now) {
  if (fd_ >= 0) return true;
  if (looked_.is_set() && now - looked_ < kLookAgain) return false;
  looked_ = now;
  // In a folder of somebody else a socket would be somebody else's.
  if (!is_private_folder(folder_)) return false;
  fd_ = datagram_socket();
  if (fd_ < 0) return false;
  if (connect_datagrams(fd_, address_) == 0) return true;
  disconnect();
  return false;
}

LocalDatagramSender::Sent LocalDatagramSender::send(std::span<const std::uint8_t> bytes,
                                                    MonoTime now) {
  if (!connect(now)) return Sent::kNobody;
  for (;;) {
    if (::send(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL) >= 0)
      return Sent::kSent;
    if (errno == EINTR) continue;
    if (errno == EAGAIN || errno == ENOBUFS) return Sent::kFull;
    // The receiver has ended; another may be there, at the same place.
    disconnect();
    return Sent::kNobody;
  }
}

}  // namespace dance
