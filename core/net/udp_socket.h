// A UDP socket that never blocks, over IPv4 or IPv6 (a socket bound to an IPv6 address also hears
// IPv4), read and written in batches: one system call for many datagrams. It may hear a multicast
// group.
//
// Units/frames: receive times are MonoTime of this process's clock; from the kernel's stamp where
//               it gives one, so that a late turn of the loop does not look like a late datagram.
// Ownership:    owns the descriptor and the batch buffers; never allocates after construction.
// Threads:      one owner.
// Failure:      bind() and connect() name the address, the reason and the cure; later errors are
//               counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/net/address.h"
#include "core/net/datagram_sink.h"

namespace dance {

// How many datagrams of what size a socket takes in one call.
struct UdpRoom {
  std::size_t datagrams = 64;
  std::size_t bytes = 2048;  // of each; longer ones are cut and counted
};
// For protocols of others, whose datagrams may be as long as UDP allows.
constexpr UdpRoom kLongDatagrams{8, 65'507};

class UdpSocket final : public DatagramSink {
 public:
  static constexpr std::size_t kBatch = UdpRoom{}.datagrams;
  static constexpr std::size_t kMaxDatagramBytes = UdpRoom{}.bytes;

  struct Datagram {
    Address from;
    std::span<const std::uint8_t> bytes;
    MonoTime received;
  };
  struct Counters {
    std::uint64_t received = 0;
    std::uint64_t received_bytes = 0;
    std::uint64_t truncated = 0;  // longer than any valid one: dropped
    std::uint64_t sent = 0;
    std::uint64_t sent_bytes = 0;
    std::uint64_t refused = 0;      // port closed at the other end (ICMP)
    std::uint64_t send_failed = 0;  // buffer full, no route
  };

  // Receives and sends from `local`; port 0 lets the system choose.
  static Result<UdpSocket> bind(const Address& local, const UdpRoom& room = {});
  // Like bind(), for a server. Datagram::from includes the address of this machine that the peer
  // sent to, and what is sent to such a `from` leaves from there: on a machine with several
  // addresses peers accept no other answer.
  static Result<UdpSocket> serve(const Address& local, const UdpRoom& room = {});
  // Receives from an IPv4 multicast group, which other programs of this machine may also do; on the
  // interface that has the address `interface`, or on the one that the system chooses.
  static Result<UdpSocket> join(const Address& group, const Address& interface,
                                const UdpRoom& room = {});
  // Exchanges datagrams with `peer` only.
  static Result<UdpSocket> connect(const Address& peer, const UdpRoom& room = {});
  UdpSocket(UdpSocket&&) noexcept;
  UdpSocket& operator=(UdpSocket&&) noexcept;
  ~UdpSocket() override;

  int fd() const { return fd_; }
  Address local_address() const;

  // Pending datagrams, as many as a batch holds; empty when there are none. Valid until the next
  // call.
  std::span<const Datagram> receive();

  // Queues a datagram; flush() sends all that is queued, and so does a full batch. On a connected
  // socket `to` is ignored.
  void send(const Address& to, std::span<const std::uint8_t> bytes) override;
  void flush();
  // At once, bypassing the batch.
  void send_now(const Address& to, std::span<const std::uint8_t> bytes);

  const Counters& counters() const { return counters_; }

 private:
  struct Batches;
  UdpSocket(int fd, Address::Family family, bool connected, const UdpRoom& room);
  static Result<UdpSocket> open(Address::Family family, bool connected, const UdpRoom& room);
  Result<void> bind_to(const Address& local);
  void count_send_error(int error);
  void close_now();

  int fd_ = -1;
  Address::Family family_;
  bool connected_;
  std::unique_ptr<Batches> batches_;
  Counters counters_;
};

// Whether the kernel supports IPv6 sockets.
bool machine_has_ipv6();

// A UDP port of 127.0.0.1 that is free at this moment.
Result<std::uint16_t> free_loopback_port();

}  // namespace dance
