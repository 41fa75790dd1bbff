// Telling other programs of this user on this machine: a Unix socket in a folder that only the user
// may enter. Whoever connects gets one text and the end; it is asked nothing.
//
// Units/frames: texts are bytes.
// Ownership:    LocalTextServer owns its socket file and at most kMaxClients connections; the
//               poller must outlive it.
// Threads:      the poller's; read_local_text() waits, and is for programs that only ask.
// Failure:      nothing that a client does, or leaves undone, makes the server wait: who does not
//               read is dropped. open() and read_local_text() say what is wrong.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/net/poller.h"

namespace dance {

// Where this user's sockets lie: $XDG_RUNTIME_DIR/dance, or /tmp/dance-UID where that is not set.
std::string local_socket_folder();

class LocalTextServer {
 public:
  using MakeText = std::function<std::string(MonoTime now)>;
  static constexpr std::size_t kMaxClients = 8;
  // However many ask, it is made at most so often.
  static constexpr Duration kTextStays = Duration::ms(500);
  static constexpr Duration kClientPatience = Duration::s(2);

  struct Counters {
    std::uint64_t answered = 0;
    std::uint64_t dropped = 0;  // did not read, or one too many
  };

  // Makes the folder, closed to others, and takes the place of a socket that nobody serves any
  // more.
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
// All that the server at `path` tells.
tl::expected<std::string, LocalFailure> read_local_text(const std::string& path, Duration patience);

}  // namespace dance
