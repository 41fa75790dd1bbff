// A crowd of guests, each with a socket of her own, and a relay between them: what `dance bench
// tunnel` dances with. The tunnel's is the real thing; the others are what it is measured against.
//
// Units/frames: guests are numbered from 0; a pose is known by its sequence.
// Ownership:    owns the guests' ends; the poller must outlive it.
// Threads:      the poller's.
// Failure:      open() tells what could not be had.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "core/base/result.h"
#include "core/bus/voice.h"
#include "core/codec/pose_codec.h"
#include "core/net/address.h"
#include "core/net/datagram_sink.h"
#include "core/net/poller.h"
#include "core/pose/pose.h"

namespace dance {

// One process plays all guests. These, from the first on, decode what they hear, and are measured;
// the others only take it in, so that the crowd's work does not stand in one queue.
constexpr std::size_t kListeners = 2;

// Of all guests together, since they began; with the 28 bytes of IP and UDP of each datagram.
struct Traffic {
  std::uint64_t bytes_up = 0, bytes_down = 0;
  std::uint64_t poses_down = 0;
  std::uint64_t payload_down = 0;  // of bytes_down, the poses themselves
  // Of the bytes above; packets of 10 ms.
  std::uint64_t voice_bytes_up = 0, voice_bytes_down = 0, voices_down = 0;
};

class Crowd {
 public:
  // A guest has decoded another's pose.
  using Heard =
      std::function<void(std::size_t listener, std::size_t sender, std::uint32_t sequence)>;

  Crowd() = default;
  virtual ~Crowd() = default;
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;

  // Every guest can be heard by every other.
  virtual bool is_open() = 0;
  virtual void send(std::size_t guest, const Pose& pose, MonoTime now) = 0;
  // 10 ms of a guest's voice; of crowds that can.
  virtual void speak(std::size_t, const Voice&, MonoTime) {}
  virtual Traffic traffic() const = 0;
};

struct CrowdOptions {
  std::size_t guests = 30;
  Address relay;
  Crowd::Heard heard;
  std::optional<CodecName> codec{};  // the tunnel's; nothing = as two houses choose
  // A listener has heard 10 ms of another guest, captured then.
  std::function<void(std::size_t listener, const Voice&)> heard_voice{};
};

// Links of the tunnel to a dance-server.
Result<std::unique_ptr<Crowd>> open_tunnel_crowd(const CrowdOptions& options, Poller& poller);

// Poses as they lie in memory, a datagram each, and a relay that copies each to all the others: one
// blocking call in, one call out. The relay runs until a signal ends its process.
Result<std::unique_ptr<Crowd>> open_udp_crowd(const CrowdOptions& options, Poller& poller);
Error relay_udp(std::uint16_t port);

// The same poses through ENet, unsequenced and unreliable, so that it neither waits nor drops.
// Built where libenet-dev is.
#if DANCE_HAVE_ENET
Result<std::unique_ptr<Crowd>> open_enet_crowd(const CrowdOptions& options, Poller& poller);
Error relay_enet(std::uint16_t port);
#endif

}  // namespace dance
