// What a link is told, what it tells back, and what it counts.
//
// Units/frames: poses handed to the handlers are in this house's clock.
// Ownership:    plain values; handlers must outlive the link.
// Threads:      none inside; handlers run on the link's thread.
// Failure:      none.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/base/fixed_list.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "tunnel/wire.h"

namespace dance {

struct LinkOptions {
  wire::RoomName room;
  FixedList<GuestId, wire::kMaxGuestsPerLink> guests;  // more may come with their first pose
  std::uint64_t token = 0;     // random, new with each start of a link; gives it its place back
  std::uint64_t clock_id = 0;  // this house's clock: poses of another one are stamped anew
  std::uint64_t seed = 1;      // for the nonces of hellos: random outside of tests
  FixedList<std::uint8_t, wire::kMaxCodecs> codecs;  // empty = all that this build knows
};

enum class LinkState : std::uint8_t {
  kConnecting,  // no session yet
  kConnected,
  kLapsed,  // had a session, hears nothing, asks for it again
};

struct LinkHandlers {
  std::function<void(const GuestId&, const Pose&, MonoTime now)> on_pose;
  std::function<void(const GuestId&, const Hands&, MonoTime now)> on_hands;
  std::function<void(const GuestId&, const Skeleton&, MonoTime now)> on_skeleton;
  std::function<void(const GuestId&, MonoTime now)> on_guest_joined;
  std::function<void(const GuestId&, MonoTime now)> on_guest_left;
  std::function<void(LinkState, MonoTime now)> on_state;
  // Guest is set where it is about one of ours. refusal_line() says it for people.
  std::function<void(const wire::RefusalNotice&, MonoTime now)> on_refused;
};

struct LinkCounters {
  std::uint64_t poses_offered = 0;  // by this house
  std::uint64_t poses_sent = 0;
  std::uint64_t poses_received = 0;  // records of poses that came in
  std::uint64_t poses_delivered = 0;
  std::uint64_t hands_sent = 0;
  std::uint64_t hands_delivered = 0;
  std::uint64_t late = 0;             // both ways: not newer than what went before
  std::uint64_t invalid = 0;          // both ways: not a pose, or of no time under way
  std::uint64_t unrouted = 0;         // not connected, or a guest without a slot
  std::uint64_t overflow = 0;         // more guests than a link may have
  std::uint64_t foreign_clock = 0;    // poses of another clock, stamped anew
  std::uint64_t stream_restarts = 0;  // producers of ours that began anew
  std::uint64_t datagrams_in = 0;
  std::uint64_t datagrams_out = 0;
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  std::uint64_t rejected_datagrams = 0;
  std::uint64_t hellos = 0;
  std::uint64_t lapses = 0;
  std::uint64_t reconnects = 0;  // sessions begun or taken up again after a lapse
};

// One guest of another house, as this link hears it.
struct RemoteGuestStats {
  GuestId guest;
  bool is_here = true;  // false: counts of one who has left
  std::uint64_t received = 0;
  std::uint64_t lost = 0;  // gaps, less what arrived late
  std::uint64_t late = 0;
  std::uint64_t duplicate = 0;
  std::uint64_t invalid = 0;
};

// One line: what was refused, why, and the cure.
std::string refusal_line(const wire::RefusalNotice& refusal, const wire::RoomName& room);

}  // namespace dance
