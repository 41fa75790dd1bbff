// The tunnel's server on a UDP port: ServerCore with a socket around it. What a turn brings in is
// forwarded in the same turn, with batched system calls; an idle server sleeps.
//
// Units/frames: MonoTime of this process's clock.
// Ownership:    owns socket and core; the poller must outlive it.
// Threads:      the poller's.
// Failure:      open() names the port that cannot be had and the cure.
#pragma once

#include <memory>
#include <vector>

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
  // UNSEALED FOR NOW: takes each address for a peer whose key allows everything. What seals
  // sessions replaces it.
  class Unsealed final : public PeerSink {
   public:
    explicit Unsealed(UdpSocket& socket) : socket_(socket) {}
    PeerId peer_at(const Address& from) {
      for (std::size_t i = 0; i < peers_.size(); ++i)
        if (peers_[i] == from) return i + 1;
      peers_.push_back(from);
      return peers_.size();
    }
    void send(PeerId to, std::span<const std::uint8_t> bytes) override {
      socket_.send(peers_[to - 1], bytes);
    }

   private:
    UdpSocket& socket_;
    std::vector<Address> peers_;
  };

  Server(UdpSocket socket, const ServerLimits& limits, Poller& poller);
  void on_readable(MonoTime now);

  Poller& poller_;
  UdpSocket socket_;
  Unsealed unsealed_;
  ServerCore core_;
  Poller::TimerId timer_;
};

}  // namespace dance
