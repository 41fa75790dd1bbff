// Bus: the house's LCM bus as a SignalPort. Messages arrive as this tree's types and are checked
// here once (finite, unit rotations, sizes); invalid ones are dropped and counted. With ttl=0 in
// its URL a bus receives only what programs of this machine sent. Messages that this program has
// not subscribed to do not wake it (core/bus/channel_filter.h).
//
// Units/frames: as in core/pose; stamps in the house's clock.
// Ownership:    owns its sockets; handlers must outlive it. Publishing allocates nothing, nor does
//               draining once every channel has been received.
// Failure:      open() names a bus that cannot be opened and the cure; later errors are counted.
// Source:       core/bus/datagram.h
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/bus/channel_pattern.h"
#include "core/bus/signal_port.h"

namespace dance {

// The default bus of a house: it stays on this machine (ttl 0).
constexpr const char* kDefaultBusUrl = "udpm://239.255.76.67:7667?ttl=0";

// The URL a program uses: what it was given, else DANCE_BUS_URL or LCM_DEFAULT_URL of the
// environment, else the default.
std::string bus_url_or_default(const std::string& given);

class Bus final : public SignalPort {
 public:
  // Prints a line to stderr, once per process, if the URL opens the bus to the network (ttl >= 1).
  static Result<std::unique_ptr<Bus>> open(const std::string& url);
  ~Bus() override;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  void send(const Channel& channel, const AnyMessage& message) override;
  void add(std::shared_ptr<Subscription> subscription) override;
  // Publishes a message from a log or another house byte for byte. One that does not fit into a
  // datagram (65,499 bytes with its name and NUL) is counted as failed.
  void publish_raw(const char* channel, const void* data, std::size_t size);

  // Receives every message of every channel, undecoded: for recorders and `dance top`. `name` may
  // be any LCM channel of printable ASCII characters.
  using RawHandler =
      std::function<void(std::string_view name, const void* data, std::size_t size, MonoTime now)>;
  void on_anything(RawHandler handler);
  // Calls `handler` with the channel of each message that was refused because it is longer than a
  // datagram; its fragments are counted. Only a program that receives everything gets these.
  using RefusedHandler = std::function<void(std::string_view name)>;
  void on_refused(RefusedHandler handler);
  // Receives undecoded messages of up to max_bytes on the channels that a pattern matches. With
  // kNewest the handler gets a copy of each channel's last message of a turn.
  void on_raw(const ChannelPattern& pattern, Delivery delivery, std::size_t max_bytes,
              RawHandler handler);

  // Becomes readable when messages are pending: give it to the poller, and call drain().
  int fd() const;
  // Passes pending messages to the handlers, at most kMessagesPerTurn, so that a flood leaves time
  // for the other descriptors of a poll loop. The descriptor stays readable while more are pending.
  static constexpr std::size_t kMessagesPerTurn = 1024;
  void drain(MonoTime now);

  const Counters& counters() const override;
  const std::string& url() const;

 private:
  struct Impl;
  explicit Bus(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace dance
