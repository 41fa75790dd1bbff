// A UDP proxy that is a bad line: what clients send to it goes on to the target, and back, after
// what the line does to it. Each client has a line and a socket of its own, so the target sees them
// as different peers.
//
// Units/frames: up is from a client to the target; traces begin when the first client comes.
// Ownership:    owns its sockets and a bounded store of datagrams under way; the poller must
//               outlive it. Allocates when a client comes, not for datagrams.
// Threads:      the poller's.
// Failure:      open() names what cannot be had; a full store drops and counts.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/base/result.h"
#include "core/net/poller.h"
#include "core/net/udp_socket.h"
#include "testing/line/lossy_model.h"

namespace dance {

class LossyProxy {
 public:
  enum class Direction : std::uint8_t { kUp, kDown };  // to the target, to the client
  struct Totals {
    LossyModel::Counters line;
    std::uint64_t delivered = 0;  // datagrams that went out, copies counted
    std::uint64_t overflow = 0;   // the store was full
  };

  static Result<std::unique_ptr<LossyProxy>> open(const Address& listen, const Address& target,
                                                  LossyLine line, Poller& poller);
  ~LossyProxy();
  LossyProxy(const LossyProxy&) = delete;
  LossyProxy& operator=(const LossyProxy&) = delete;

  // Sees all that comes in, before the line does anything to it.
  using Tap = std::function<void(Direction, std::span<const std::uint8_t>)>;
  void set_tap(Tap tap) { tap_ = std::move(tap); }

  Address local_address() const { return listen_.local_address(); }
  std::size_t client_count() const { return clients_.size(); }
  Totals totals(Direction direction) const;
  std::uint64_t refused_clients() const { return refused_clients_; }
  // When the traces began: with the first client, and for all of them, as on a line that they
  // share.
  MonoTime begin() const { return begin_; }

 private:
  struct Client {
    Address address;
    UdpSocket upstream;
    LossyModel up;
    LossyModel down;
  };
  struct Parcel {
    MonoTime due;
    std::uint64_t order = 0;  // of two due at once, the first in is the first out
    std::size_t client = 0;
    Direction direction = Direction::kUp;
    std::size_t size = 0;
    std::array<std::uint8_t, UdpSocket::kMaxDatagramBytes> bytes;
  };

  LossyProxy(UdpSocket listen, const Address& target, LossyLine line, Poller& poller);
  void on_client_side(MonoTime now);
  void on_target_side(std::size_t client, MonoTime now);
  std::size_t find_or_add(const Address& from, MonoTime came);
  void carry(std::size_t client, Direction direction, std::span<const std::uint8_t> bytes,
             MonoTime now);
  void deliver(std::size_t client, Direction direction, std::span<const std::uint8_t> bytes);
  MonoTime deliver_due(MonoTime now);
  bool is_later(std::size_t a, std::size_t b) const;

  Poller& poller_;
  Tap tap_;
  UdpSocket listen_;
  Address target_;
  LossyLine line_;
  MonoTime begin_;
  Poller::TimerId timer_;
  std::vector<std::unique_ptr<Client>> clients_;
  std::vector<Parcel> store_;
  std::vector<std::size_t> free_;
  std::vector<std::size_t> heap_;  // places in store_, the earliest due on top
  std::uint64_t order_ = 0;
  std::array<std::uint64_t, 2> delivered_{};
  std::array<std::uint64_t, 2> overflow_{};
  std::uint64_t refused_clients_ = 0;
};

}  // namespace dance
