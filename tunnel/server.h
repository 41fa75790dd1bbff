// The tunnel's server on a UDP port: ServerCore with a socket around it. What a turn brings in is
// forwarded in the same turn, with batched system calls; an idle server sleeps.
//
// Units/frames: MonoTime of this process's clock.
// Ownership:    owns socket and core; the poller must outlive it.
// Threads:      the poller's.
// Failure:      open() names the port that cannot be had and the cure.
#pragma once

#include <memory>

#include "core/base/result.h"
#include "core/net/poller.h"
#include "core/net/udp_socket.h"
#include "tunnel/server_core.h"

namespace dance {

constexpr std::uint16_t kDefaultServerPort = 7400;

class Server {
 public:
  static Result<std::unique_ptr<Server>> open(const Address& local, const ServerLimits& limits,
                                              Poller& poller);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // Tells every link, so that none has to notice the silence.
  void say_goodbye();

  Address local_address() const { return socket_.local_address(); }
  const ServerCore& core() const { return core_; }
  const UdpSocket::Counters& socket_counters() const { return socket_.counters(); }

 private:
  Server(UdpSocket socket, const ServerLimits& limits, Poller& poller);
  void on_readable(MonoTime now);

  Poller& poller_;
  UdpSocket socket_;
  ServerCore core_;
  Poller::TimerId timer_;
};

}  // namespace dance
