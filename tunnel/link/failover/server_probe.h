// How far servers are from here: each is asked a few times with a datagram that needs no session
// and no key, and answers that it knows no such session.
//
// Units/frames: MonoTime of the poller's clock.
// Ownership:    owns a socket for each server; the poller must outlive it.
// Threads:      the poller's.
// Failure:      a server that does not answer, or to which there is no way, has no round trip.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/net/poller.h"
#include "core/net/udp_socket.h"

namespace dance {

class ServerProbe {
 public:
  explicit ServerProbe(Poller& poller) : poller_(poller) {}
  ~ServerProbe();
  ServerProbe(const ServerProbe&) = delete;
  ServerProbe& operator=(const ServerProbe&) = delete;

  // Forgets earlier ones, and asks these.
  void begin(std::span<const Address> servers, MonoTime now);
  // Asks again what is due. Call at next_deadline().
  void tick(MonoTime now);
  MonoTime next_deadline() const { return next_; }
  // All have been asked as often as they are, and had time to answer.
  bool is_done() const { return !questions_.empty() && !next_.is_set(); }
  // The shortest; nothing where it did not answer.
  std::optional<Duration> round_trip(const Address& server) const;

 private:
  struct Question {
    Address to;
    UdpSocket socket;
    std::uint64_t id = 0;
    MonoTime asked;
    std::optional<Duration> shortest;
  };
  void ask(Question& question, MonoTime now);
  void on_readable(std::size_t which);
  void clear();

  Poller& poller_;
  std::vector<Question> questions_;
  int rounds_ = 0;
  MonoTime next_;
};

}  // namespace dance
