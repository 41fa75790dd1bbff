// HouseAvatars: what the guests of this house look like: as the session file states it, or as a
// program of this user has chosen since. Published again each second, for displays that start
// later.
//
// Units/frames: times of this house's clock.
// Ownership:    refers to the port, which must outlive it.
// Threads:      the poller's.
// Failure:      none of its own.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/bus/signal_port.h"
#include "house/avatar_choice.h"

namespace dance {

class HouseAvatars {
 public:
  // Hears choices for all who dance in this house.
  HouseAvatars(SignalPort& port, std::uint64_t clock_id);

  void choose(const GuestId& guest, const ChosenAvatar& chosen, MonoTime now);
  void publish_second(MonoTime now);

 private:
  struct Known {
    std::optional<Avatar> avatar;
    std::optional<AvatarFile> file;
  };
  Known* known_of(const GuestId& guest);

  SignalPort& port_;
  std::uint64_t clock_id_;
  std::map<GuestId, Known> known_;
};

}  // namespace dance
