// Who is heard where many speak: each receiver has so many places for talkers. A talker keeps
// one while speaking, and leaves it after half a second of silence; where all are taken, a talker
// who is clearly louder than the quietest takes that one's place.
//
// Units/frames: MonoTime of the server's clock; guests by slot; loudness in dBFS.
// Ownership:    plain values of fixed size.
// Threads:      none inside.
// Failure:      levels are what senders say of themselves: a liar gets one place, and a house can
//               mute that guest.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/fixed_list.h"
#include "core/base/time.h"
#include "core/bus/voice.h"

namespace dance {

// A guest's loudness: the newest frame's level, or what is left of louder ones before it.
class Loudness {
 public:
  static constexpr double kSinks_db_per_s = 20.0;

  void add(int level_dbfs, MonoTime now) {
    level_dbfs_ = std::max(static_cast<double>(level_dbfs), at(now));
    at_ = now;
  }
  double at(MonoTime now) const {
    if (!at_.is_set()) return kSilence_dbfs;
    const double sunk = level_dbfs_ - kSinks_db_per_s * std::max(0.0, (now - at_).as_seconds());
    return std::max(sunk, static_cast<double>(kSilence_dbfs));
  }

 private:
  double level_dbfs_ = kSilence_dbfs;
  MonoTime at_;
};

constexpr std::size_t kMaxTalkers = 8;

class TalkerPlaces {
 public:
  static constexpr Duration kLeavesAfter = Duration::ms(500);
  static constexpr double kClearlyLouder_db = 6.0;

  // The place of who speaks now, below kMaxTalkers: the longest heard have the first ones.
  // kMaxTalkers: none. `loudness_of(slot)` tells it of any guest.
  template <class LoudnessOf>
  std::size_t take(std::uint8_t slot, MonoTime now, const LoudnessOf& loudness_of) {
    for (std::size_t i = 0; i < places_.size();) {
      if (places_[i].slot != slot && now - places_[i].heard > kLeavesAfter)
        places_.erase_at(i);
      else
        ++i;
    }
    const auto own = std::ranges::find(places_, slot, &Place::slot);
    if (own != places_.end()) {
      own->heard = now;
      return static_cast<std::size_t>(own - places_.begin());
    }
    if (places_.try_push({slot, now})) return places_.size() - 1;
    const auto quietest = std::ranges::min_element(
        places_, {}, [&](const Place& place) { return loudness_of(place.slot); });
    if (loudness_of(slot) < loudness_of(quietest->slot) + kClearlyLouder_db) return kMaxTalkers;
    *quietest = {slot, now};
    return static_cast<std::size_t>(quietest - places_.begin());
  }

 private:
  struct Place {
    std::uint8_t slot = 0;
    MonoTime heard;
  };
  FixedList<Place, kMaxTalkers> places_;
};

}  // namespace dance
