// Messages from programs of this user to one program on this machine, over a Unix socket that keeps
// them apart (SOCK_SEQPACKET), in the user's private folder.
//
// Units/frames: bytes; a message has kMostBytes at most.
// Ownership:    LocalMessageServer owns its socket file and its connections; the poller must
//               outlive it. Neither class allocates while messages pass.
// Threads:      one owner each. Neither waits.
// Failure:      open() names the cause. A connection of another user than this one or root is
//               closed and counted; no client can make the server wait.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/net/poller.h"

namespace dance {

class LocalMessageServer {
 public:
  static constexpr std::size_t kMostClients = 64;
  static constexpr std::size_t kMostBytes = 2048;
  using OnMessage = std::function<void(std::span<const std::uint8_t> message, MonoTime now)>;

  struct Counters {
    std::uint64_t refused_users = 0;    // neither this user's nor root's
    std::uint64_t refused_clients = 0;  // more than kMostClients
    std::uint64_t oversized = 0;        // messages of more than kMostBytes
  };

  // The path must be new: numbered_control_path() makes one.
  static Result<std::unique_ptr<LocalMessageServer>> open(const std::string& path,
                                                          OnMessage on_message, Poller& poller);
  ~LocalMessageServer();
  LocalMessageServer(const LocalMessageServer&) = delete;
  LocalMessageServer& operator=(const LocalMessageServer&) = delete;

  const std::string& path() const { return path_; }
  const Counters& counters() const { return counters_; }

 private:
  LocalMessageServer(int fd, std::string path, OnMessage on_message, Poller& poller);
  void watch();
  void accept_some(MonoTime now);
  void take(int fd);
  void read(int& fd, MonoTime now);

  Poller& poller_;
  int fd_;
  bool is_watched_ = false;
  std::string path_;
  OnMessage on_message_;
  std::array<int, kMostClients> clients_;
  Poller::TimerId timer_;
  Counters counters_;
};

// A connection to such a server.
class LocalMessageSender {
 public:
  enum class Sent : std::uint8_t { kSent, kFull, kGone };

  // Returns nullopt if no program serves the path; removes the socket file of a killed program.
  static std::optional<LocalMessageSender> connect(const std::string& path);
  ~LocalMessageSender();
  LocalMessageSender(LocalMessageSender&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  LocalMessageSender& operator=(LocalMessageSender&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }

  // One message of two parts. kFull: the server does not read; the message is lost.
  Sent send(std::span<const std::uint8_t> head, std::span<const std::uint8_t> body);

 private:
  explicit LocalMessageSender(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace dance
