// Publishes a text to other programs of this user on this machine: a Unix socket in a folder
// private to the user. Each connection receives one text and is closed.
//
// Units/frames: texts are bytes.
// Ownership:    LocalTextServer owns its socket file and at most kMaxClients connections; the
//               poller must outlive it.
// Threads:      the poller's; read_local_text() blocks, for command-line clients.
// Failure:      no client can make the server wait: one that does not read is dropped. open() and
//               read_local_text() say what is wrong.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/net/local_address.h"
#include "core/net/poller.h"

namespace dance {

class LocalTextServer {
 public:
  using MakeText = std::function<std::string(MonoTime now)>;
  static constexpr std::size_t kMaxClients = 8;
  // The text is made at most this often.
  static constexpr Duration kTextStays = Duration::ms(500);
  static constexpr Duration kClientTimeout = Duration::s(2);

  struct Counters {
    std::uint64_t answered = 0;
    std::uint64_t dropped = 0;  // did not read, or beyond kMaxClients
  };

  // Makes the private folder, and replaces a socket that no process serves.
  static Result<std::unique_ptr<LocalTextServer>> open(const std::string& path, MakeText make_text,
                                                       Poller& poller);
  ~LocalTextServer();
  LocalTextServer(const LocalTextServer&) = delete;
  LocalTextServer& operator=(const LocalTextServer&) = delete;

  const std::string& path() const { return path_; }
  const Counters& counters() const { return counters_; }
  std::size_t client_count() const;

 private:
  struct Client {
    int fd = -1;
    std::shared_ptr<const std::string> text;
    std::size_t sent = 0;
    MonoTime give_up;
  };

  LocalTextServer(int fd, std::string path, MakeText make_text, Poller& poller);
  void watch();
  void on_readable(MonoTime now);
  void accept_one(int fd, MonoTime now);
  void send_on(Client& client, MonoTime now);
  void end(Client& client, std::uint64_t& count);
  MonoTime on_timer(MonoTime now);

  Poller& poller_;
  int fd_;
  bool is_watched_ = false;
  std::string path_;
  MakeText make_text_;
  std::shared_ptr<const std::string> text_;
  MonoTime text_made_;
  std::array<Client, kMaxClients> clients_;
  Poller::TimerId timer_;
  Counters counters_;
};

enum class LocalTrouble : std::uint8_t { kNobody, kNotYours, kSilent, kOther };
struct LocalFailure {
  LocalTrouble trouble = LocalTrouble::kOther;
  std::string reason;
};
// The text of the server at `path`.
tl::expected<std::string, LocalFailure> read_local_text(const std::string& path, Duration timeout);

}  // namespace dance
