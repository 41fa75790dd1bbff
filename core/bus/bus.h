// Bus: the house's LCM bus as a SignalPort. Messages come out as this tree's types, checked once
// here (finite, unit rotations, sizes); invalid ones are dropped and counted. Everything pending is
// drained in each turn, as LCM's own queue would keep the oldest messages and drop the new ones.
// Messages that this program has not subscribed to do not wake it (core/bus/channel_filter.h).
//
// Units/frames: as in core/pose; stamps in the house's clock.
// Ownership:    owns the LCM handle; handlers must outlive it. Publishing and draining allocate
//               nothing of ours once every channel has been heard once.
// Threads:      one (LCM's own receive thread inside hands over through a pipe).
// Failure:      open() names a bus that cannot be had and the cure; later trouble is counted.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/bus/channel_pattern.h"
#include "core/bus/signal_port.h"

namespace dance {

// The house's bus unless told otherwise: stays on this machine (ttl 0).
constexpr const char* kDefaultBusUrl = "udpm://239.255.76.67:7667?ttl=0";

// The URL a program uses: what it was given, else DANCE_BUS_URL or LCM_DEFAULT_URL of the
// environment, else the default.
std::string bus_url_or_default(const std::string& given);

class Bus final : public SignalPort {
 public:
  static Result<std::unique_ptr<Bus>> open(const std::string& url);
  ~Bus() override;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  void send(const Channel& channel, const AnyMessage& message) override;
  void add(std::shared_ptr<Subscription> subscription) override;
  // A message as it came from a log or another house: published byte for byte.
  void publish_raw(const char* channel, const void* data, std::size_t size);

  // Every message of every channel, undecoded: for recorders and `dance top`. `name` may be any LCM
  // channel.
  using RawHandler =
      std::function<void(std::string_view name, const void* data, std::size_t size, MonoTime now)>;
  void on_anything(RawHandler handler);
  // Undecoded messages of up to max_bytes, of the channels that a pattern matches. With kNewest a
  // handler gets a copy of each channel's last one of a turn.
  void on_raw(const ChannelPattern& pattern, Delivery delivery, std::size_t max_bytes,
              RawHandler handler);

  // Becomes readable when messages are pending: give it to the poller, and call drain().
  int fd() const;
  // Hands everything pending to the handlers.
  void drain(MonoTime now);

  const Counters& counters() const override;
  const std::string& url() const;

 private:
  struct Impl;
  explicit Bus(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace dance
