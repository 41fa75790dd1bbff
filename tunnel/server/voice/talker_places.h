// Chooses the talkers that one receiver gets. There are eight places. The key of one person has at
// most one of them, whatever links and guests use it. A talker keeps the place until half a second
// of silence. When all places are taken, a key without a place replaces a link of a shared key that
// holds several. Otherwise the talker with the most recent talk time gives way to one with less.
//
// Talk time is the time for which a place was held, not the number of packets: a place that is kept
// with two packets a second is as lost to others as one that carries speech. Loudness does not
// count: senders state it themselves.
//
// Several people share the key of a room, so there each link is a talker. Links choose their
// tokens: a link that is not known starts with the highest talk time of its key. Then a new token
// gains nothing, and a newcomer waits until the talkers have been heard more recently.
//
// Units/frames: MonoTime of the server's clock; guests by slot.
// Ownership:    plain values of fixed size.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/fixed_list.h"
#include "core/base/time.h"
#include "tunnel/policy/owner_key.h"
#include "tunnel/wire/wire.h"

namespace dance {

// Recent talk time: it counts half after each ten seconds.
class TalkTime {
 public:
  void add(Duration held, MonoTime now) {
    seconds_ = seconds_at(now) + held.as_seconds();
    at_ = now;
  }
  double seconds_at(MonoTime now) const {
    if (!at_.is_set()) return 0.0;
    return seconds_ * std::exp2(-std::max(0.0, (now - at_).as_seconds()) / kHalfLife_s);
  }

 private:
  static constexpr double kHalfLife_s = 10.0;
  double seconds_ = 0.0;
  MonoTime at_;
};

constexpr std::size_t kMaxTalkers = 8;

class TalkerPlaces {
 public:
  static constexpr Duration kLeavesAfter = Duration::ms(500);
  // A talker gives way to one whose talk time is shorter by this much.
  static constexpr double kTurn_s = 2.0;

  // Counts a packet of the guest in `slot`. Returns the talker's place, or kMaxTalkers without one.
  // The receiver's line bears the voices of the first `audible` places. Talkers get turns there,
  // too, and talk time counts there alone.
  std::size_t take(std::uint8_t slot, const OwnerKey& key, std::uint64_t link_token,
                   std::size_t audible, MonoTime now) {
    const Talker talker{key, key.is_shared ? link_token : 0};
    drop_silent(talker, now);
    Place* place = std::ranges::find(places_, talker, &Place::talker);
    if (place == places_.end()) {
      const TalkTime earlier = earlier_talk(slot, talker, now);
      place = place_for(talker, earlier, now);
      if (place == places_.end()) {
        // Its talk time fades from now on.
        if (key.is_shared) links_[slot] = {talker, earlier};
        return kMaxTalkers;
      }
      *place = {talker, slot, now, earlier};
      count_places();
    } else if (place->slot != slot) {
      if (!is_silent(*place, now)) return kMaxTalkers;  // another guest of the talker speaks
      place->slot = slot;
    }
    if (place >= places_.begin() + audible) place = place_in_turn(place, audible, now);
    if (place < places_.begin() + audible) place->talk.add(held(*place, now), now);
    place->heard = now;
    return static_cast<std::size_t>(place - places_.begin());
  }

 private:
  struct Talker {
    OwnerKey key;
    std::uint64_t link = 0;  // token; only of a shared key
    bool operator==(const Talker&) const = default;
  };
  struct Place {
    Talker talker;
    std::uint8_t slot = 0;
    MonoTime heard;
    TalkTime talk;  // until `heard`
    std::size_t places_of_key = 0;
  };
  // For a shared key: the highest talk time of its links.
  struct KeyTalk {
    OwnerKey key;
    TalkTime talk;
  };
  struct LinkTalk {
    Talker talker;
    TalkTime talk;
  };

  static Duration held(const Place& place, MonoTime now) {
    return std::clamp(now - place.heard, Duration{}, kLeavesAfter);
  }
  static double talk_s(const Place& place, MonoTime now) {
    return place.talk.seconds_at(now) + held(place, now).as_seconds();
  }
  static bool is_silent(const Place& place, MonoTime now) {
    return now - place.heard > kLeavesAfter;
  }

  void drop_silent(const Talker& but, MonoTime now) {
    for (std::size_t i = 0; i < places_.size();) {
      if (places_[i].talker == but || !is_silent(places_[i], now)) {
        ++i;
        continue;
      }
      remember(places_[i], now);
      places_.erase_at(i);
      count_places();
    }
  }
  void count_places() {
    for (Place& place : places_) place.places_of_key = places_of(place.talker.key);
  }
  std::size_t places_of(const OwnerKey& key) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        places_, [&](const Place& place) { return place.talker.key == key; }));
  }

  // A place that is free, or whose talker gives way; end() if there is none.
  Place* place_for(const Talker& talker, const TalkTime& earlier, MonoTime now) {
    if (places_.try_push({})) return places_.end() - 1;
    const std::size_t own = places_of(talker.key);
    const std::size_t most =
        std::ranges::max_element(places_, {}, &Place::places_of_key)->places_of_key;
    // A key that has two places more gives one up at once, for good: then the difference is less.
    const bool is_owed = most >= own + 2;
    Place* longest = places_.end();
    double longest_s = 0.0;
    for (Place& place : places_) {
      const bool may_give_way = is_owed
                                    ? place.places_of_key == most
                                    : place.places_of_key > own || place.talker.key == talker.key;
      if (!may_give_way) continue;
      const double seconds = talk_s(place, now);
      if (longest != places_.end() && seconds <= longest_s) continue;
      longest = &place;
      longest_s = seconds;
    }
    if (longest == places_.end()) return longest;
    if (!is_owed && earlier.seconds_at(now) + kTurn_s > longest_s) return places_.end();
    remember(*longest, now);
    return longest;
  }

  // For a talker beyond the first `audible` places: one of these if its turn has come, or else its
  // own.
  Place* place_in_turn(Place* place, std::size_t audible, MonoTime now) {
    if (audible == 0) return place;
    Place* longest = std::max_element(
        places_.begin(), places_.begin() + audible,
        [&](const Place& a, const Place& b) { return talk_s(a, now) < talk_s(b, now); });
    if (place->talk.seconds_at(now) + kTurn_s > talk_s(*longest, now)) return place;
    longest->talk.add(held(*longest, now), now);
    std::swap(*place, *longest);
    longest->heard = now;
    return longest;
  }

  TalkTime earlier_talk(std::uint8_t slot, const Talker& talker, MonoTime now) const {
    if (talker.key.is_shared && links_[slot].talker == talker) return links_[slot].talk;
    const auto known = std::ranges::find(keys_, talker.key, &KeyTalk::key);
    TalkTime highest = known == keys_.end() ? TalkTime() : known->talk;
    for (Place place : places_) {
      if (place.talker.key != talker.key) continue;
      place.talk.add(held(place, now), now);
      if (place.talk.seconds_at(now) > highest.seconds_at(now)) highest = place.talk;
    }
    return highest;
  }
  // Keeps the talk time of a talker that leaves its place. Of too many keys the one with the least
  // is forgotten.
  void remember(Place& place, MonoTime now) {
    place.talk.add(held(place, now), now);
    if (place.talker.key.is_shared) links_[place.slot] = {place.talker, place.talk};
    auto entry = std::ranges::find(keys_, place.talker.key, &KeyTalk::key);
    if (entry == keys_.end() && keys_.try_push({})) entry = keys_.end() - 1;
    if (entry == keys_.end())
      entry = std::ranges::min_element(keys_, {},
                                       [&](const KeyTalk& it) { return it.talk.seconds_at(now); });
    const bool is_lower =
        entry->key == place.talker.key && place.talk.seconds_at(now) < entry->talk.seconds_at(now);
    if (!is_lower) *entry = {place.talker.key, place.talk};
  }

  FixedList<Place, kMaxTalkers> places_;
  FixedList<KeyTalk, wire::kSlotsPerPage> keys_;           // without a place, or had one
  std::array<LinkTalk, wire::kMaxGuestsPerRoom> links_{};  // by slot; of shared keys
};

}  // namespace dance
