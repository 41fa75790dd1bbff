// What a crowd is to do: how many guests in how many rooms of which servers, and how they dance.
//
// Guests are numbered from 0 over all rooms. They are dealt: the first to the first room, the next
// to the next; and the guests of each room in the same way over the servers.
//
// Units/frames: rates are a second; seconds are of wall time.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      checked_plan() says what does not fit, and the cure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "tunnel/link/link_key.h"
#include "tunnel/policy/interest.h"
#include "tunnel/wire/wire.h"

namespace dance {

constexpr std::size_t kMostCrowdGuests = 10'000;
constexpr std::size_t kMostCrowdThreads = 64;

struct CrowdPlan {
  std::vector<std::string> servers;  // as the user names them; none = one of its own
  std::size_t guests = 30;           // in all
  std::size_t rooms = 1;
  std::size_t threads = 1;
  std::size_t decoders = SIZE_MAX;  // guests of each room who decode what they hear
  double hz = 30.0;
  double seconds = 10.0;           // measured, once all are there; 0 = until it is stopped
  double join_rate = 15.0;         // guests
  double wait_s = 15.0;            // for the last one to be in
  double churn = 0.0;              // guests who leave, and come back one to three seconds later
  bool is_together = false;        // everybody's pose at the same moment, not spread over the frame
  double share_ms = -1.0;          // of its own server; < 0 = as that chooses
  std::string room = "crowd";      // with -1, -2 … where there are several
  std::string name = "guest";      // of guests: with -1, -2 …
  std::vector<std::string> takes;  // recorded dances; none = the synthetic one
  LinkKeySource key;
  Interest interest;
  std::vector<std::string> cpu_of;  // process numbers of servers on this machine

  std::size_t room_of(std::size_t guest) const { return guest % rooms; }
  std::size_t place_of(std::size_t guest) const { return guest / rooms; }  // in its room
  std::size_t server_of(std::size_t guest) const { return place_of(guest) % servers.size(); }
  std::size_t guest_at(std::size_t in_room, std::size_t place) const {
    return place * rooms + in_room;
  }
  // Guests of the fullest room.
  std::size_t guests_per_room() const { return (guests + rooms - 1) / rooms; }
  // checked_plan() has seen that there are such names.
  wire::RoomName room_name(std::size_t in_room) const;
  GuestId guest_name(std::size_t place) const;
  // Nothing for a name that is not of this crowd.
  std::optional<std::size_t> place_of(const GuestId& name) const;
};

Result<CrowdPlan> checked_plan(CrowdPlan plan);

}  // namespace dance
