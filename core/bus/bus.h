// Bus: the house's LCM bus behind a seam. Messages come out as this tree's types, checked once here
// (finite, unit rotations, sizes); what is not right is dropped and counted. Everything pending is
// drained in each turn, as LCM's own queue would keep the oldest messages and drop the new. What
// nobody here subscribed to wakes nobody here (core/bus/channel_filter.h).
//
// Units/frames: as in core/pose; stamps in the house's clock.
// Ownership:    owns the LCM handle; handlers must outlive it. Publishing and draining allocate
//               nothing of ours once every channel has been heard once.
// Threads:      one (LCM's own receive thread inside hands over through a pipe).
// Failure:      open() names a bus that cannot be had and the cure; later trouble is counted.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/base/beat.h"
#include "core/base/result.h"
#include "core/bus/channel.h"
#include "core/bus/channel_pattern.h"
#include "core/bus/messages.h"
#include "core/bus/state_messages.h"
#include "core/pose/pose.h"

namespace dance {

// The house's bus unless told otherwise: stays on this machine (ttl 0).
constexpr const char* kDefaultBusUrl = "udpm://239.255.76.67:7667?ttl=0";

// The URL a program uses: what it was given, else DANCE_BUS_URL or LCM_DEFAULT_URL of the
// environment, else the default.
std::string bus_url_or_default(const std::string& given);

enum class Delivery {
  kEvery,   // every message, in order
  kNewest,  // of each channel only the newest of a turn; the others are counted as superseded
};

class Bus {
 public:
  struct Counters {
    std::uint64_t received = 0;     // messages decoded
    std::uint64_t superseded = 0;   // kNewest: a newer one was already there
    std::uint64_t undecodable = 0;  // another type or version on our channel
    std::uint64_t invalid = 0;      // decoded, but not finite, not unit, out of range
    std::uint64_t unknown = 0;      // on a channel that we subscribed to but cannot parse
    std::uint64_t publish_failed = 0;
    std::uint64_t oversized = 0;  // of on_raw(): longer than its subscriber takes
  };
  template <class T>
  using Handler = std::function<void(const Channel& channel, const T& message, MonoTime now)>;

  static Result<std::unique_ptr<Bus>> open(const std::string& url);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  void publish(const Channel& channel, const Pose& pose);
  void publish(const Channel& channel, const Hands& hands);
  void publish(const Channel& channel, const TimedSkeleton& skeleton);
  void publish(const Channel& channel, const GuestStatus& status);
  void publish(const Channel& channel, const Stats& stats);
  void publish(const Channel& channel, const StageTime& stage_time);
  void publish(const Channel& channel, const Music& music);
  void publish(const Channel& channel, const Scene& scene);
  void publish(const Channel& channel, const Avatar& avatar);
  void publish(const Channel& channel, const Style& style);
  void publish(const Channel& channel, const Placement& placement);
  void publish(const Channel& channel, const Beat& beat);
  // A message as it came from a log or another house: published byte for byte.
  void publish_raw(const char* channel, const void* data, std::size_t size);

  // Subscribes to <SIGNAL>/<where>/<guest>, or to all guests where guest is not set.
  void on_pose(Where where, const GuestId& guest, Delivery delivery, Handler<Pose> handler);
  void on_hands(Where where, const GuestId& guest, Delivery delivery, Handler<Hands> handler);
  void on_skeleton(Where where, const GuestId& guest, Handler<TimedSkeleton> handler);
  void on_guest_status(Handler<GuestStatus> handler);
  void on_stats(Handler<Stats> handler);
  void on_stage_time(Handler<StageTime> handler);
  void on_music(Where where, const GuestId& guest, Handler<Music> handler);
  void on_scene(Where where, const GuestId& guest, Handler<Scene> handler);
  void on_avatar(Where where, const GuestId& guest, Handler<Avatar> handler);
  void on_style(Where where, const GuestId& guest, Handler<Style> handler);
  void on_beat(Handler<Beat> handler);
  void on_placement(Where where, const GuestId& guest, Handler<Placement> handler);
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

  const Counters& counters() const;
  const std::string& url() const;

 private:
  struct Impl;
  explicit Bus(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace dance
