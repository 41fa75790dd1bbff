// Datagrams from a program of this user to another one on this machine, through a socket in the
// user's private folder: LocalDatagramSocket receives, LocalDatagramSender sends.
//
// Units/frames: bytes.
// Ownership:    LocalDatagramSocket owns its socket file. Neither allocates after construction.
// Threads:      one owner each. Neither waits.
// Failure:      bind() names a path that another program serves. The sender says when nobody is
//               there or the receiver's queue is full; a missing receiver is looked for at most ten
//               times a second.
#pragma once

#include <sys/stat.h>
#include <sys/un.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

class LocalDatagramSocket {
 public:
  // Makes the private folder, and replaces a socket that no process serves.
  static Result<std::unique_ptr<LocalDatagramSocket>> bind(const std::string& path);
  // Whether a process serves it; removes the file that a killed one left in this user's folder.
  static bool is_served(const std::string& path);
  ~LocalDatagramSocket();
  LocalDatagramSocket(const LocalDatagramSocket&) = delete;
  LocalDatagramSocket& operator=(const LocalDatagramSocket&) = delete;

  int fd() const { return fd_; }
  const std::string& path() const { return path_; }
  // One that is pending: its length, which may be more than fits into the buffer; -1 for none.
  std::ptrdiff_t receive(std::span<std::uint8_t> buffer);

 private:
  LocalDatagramSocket(int fd, std::string path, const struct stat& made)
      : fd_(fd), path_(std::move(path)), device_(made.st_dev), inode_(made.st_ino) {}
  int fd_;
  std::string path_;
  // Of the socket file: another program may have removed it and made its own.
  dev_t device_;
  ino_t inode_;
};

class LocalDatagramSender {
 public:
  enum class Sent : std::uint8_t { kSent, kNobody, kFull };
  static constexpr Duration kLookAgain = Duration::ms(100);

  static Result<std::unique_ptr<LocalDatagramSender>> open(const std::string& path);
  ~LocalDatagramSender();
  LocalDatagramSender(const LocalDatagramSender&) = delete;
  LocalDatagramSender& operator=(const LocalDatagramSender&) = delete;

  Sent send(std::span<const std::uint8_t> bytes, MonoTime now);

 private:
  LocalDatagramSender(const sockaddr_un& address, std::string folder)
      : address_(address), folder_(std::move(folder)) {}
  bool connect(MonoTime now);
  void disconnect();

  sockaddr_un address_;
  std::string folder_;
  int fd_ = -1;
  MonoTime looked_;
};

}  // namespace dance
