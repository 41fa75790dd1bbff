// BusSocket: an endpoint of LCM's UDP protocol: one socket that receives and one that sends, both
// without blocking. With ttl 0 it receives only what programs of this machine sent, and sends over
// the loopback device, so it needs no route and is not disturbed when routes change. With ttl 1 and
// more it sends over the device of the multicast route, and over loopback while there is none.
//
// Ownership: owns the descriptors and the receive buffers. After open() and want() it allocates
//            only in follow_network(), when the network has changed.
// Failure:   open() names what the kernel refused and the cure. send() returns false for what could
//            not be sent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/bus/bus_url.h"
#include "core/bus/channel_filter.h"
#include "core/bus/route/multicast_watch.h"

namespace dance {

class BusSocket {
 public:
  // The most datagrams that one receive() returns.
  static constexpr std::size_t kBatch = 16;

  static Result<BusSocket> open(const BusAddress& address);
  BusSocket(BusSocket&&) noexcept;
  ~BusSocket();

  // Readable when datagrams are pending, or a report of a network change: then call
  // follow_network().
  int fd() const { return poll_fd_ >= 0 ? poll_fd_ : receive_fd_; }
  // Adds channels with this beginning to those that are received; "" adds all, and fragments.
  // The socket receives nothing before the first call.
  void want(std::string_view beginning);

  // Pending datagrams; fewer than kBatch when no more are pending. Valid until the next call.
  std::span<const std::span<const std::uint8_t>> receive();

  bool send(std::string_view name, const void* data, std::size_t size);

  // Joins the group on the device that the multicast route has moved to. Returns a line that tells
  // the user what has changed for this bus, "" if nothing has.
  std::string follow_network();

 private:
  struct Buffers;
  explicit BusSocket(const BusAddress& address);
  Result<void> open_receive();
  Result<void> open_send();
  void open_watch();
  void join_device(int device);

  BusAddress address_;
  ChannelFilter filter_;
  int receive_fd_ = -1;
  int send_fd_ = -1;
  int poll_fd_ = -1;                       // an epoll of receive_fd_ and the watch
  std::unique_ptr<MulticastWatch> watch_;  // nullptr where the kernel reports no changes
  MulticastWatch::State network_;
  // Devices beside loopback on which the group was joined, the newest last. A program that started
  // on an earlier one may still send there. The kernel allows 20 for each socket.
  std::vector<int> joined_;
  std::uint32_t sequence_ = 0;
  std::unique_ptr<Buffers> buffers_;
};

}  // namespace dance
