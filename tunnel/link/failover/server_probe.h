// Measures round trips to servers. Each is sent one datagram that needs no session and no key, and
// answers that it knows no such session. Only one, because a server can list hosts that never asked
// for it: tunnel/link/failover/server_candidates.h. The answer repeats a random id, so only a host
// that received the datagram, or one on the path, can send it.
//
// Units/frames: MonoTime of the poller's clock.
// Ownership:    owns a socket for each server; the poller must outlive it.
// Threads:      the poller's.
// Failure:      a server that does not answer, or to which there is no route, has no round trip.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/net/poller.h"
#include "core/net/udp_socket.h"

namespace dance {

class ServerProbe {
 public:
  using OnAnswer = std::function<void(const Address& server)>;
  ServerProbe(Poller& poller, OnAnswer on_answer)
      : poller_(poller), on_answer_(std::move(on_answer)) {}
  ~ServerProbe();
  ServerProbe(const ServerProbe&) = delete;
  ServerProbe& operator=(const ServerProbe&) = delete;

  // Forgets earlier answers, and sends each of these a datagram.
  void begin(std::span<const Address> servers, MonoTime now);
  // Ends the wait for answers. Call at next_deadline().
  void tick(MonoTime now);
  MonoTime next_deadline() const { return next_; }
  // Every server had time to answer.
  bool is_done() const { return !questions_.empty() && !next_.is_set(); }
  // Returns nullopt if the server did not answer.
  std::optional<Duration> round_trip(const Address& server) const;

 private:
  struct Question {
    Address to;
    UdpSocket socket;
    std::uint64_t id = 0;
    MonoTime asked;
    std::optional<Duration> round_trip;
  };
  void ask(Question& question, MonoTime now);
  void on_readable(std::size_t which);
  void clear();

  Poller& poller_;
  OnAnswer on_answer_;
  std::vector<Question> questions_;
  MonoTime next_;
};

}  // namespace dance
