// HapticMaker: what a dancer is to feel of touches, of the beat, and of the lead's hand in a hold:
// push, pull, raise and to the side, each with its own pattern. Pure: what it makes goes to a sink.
//
// Units/frames: times of this house's clock; touches as lcmtypes/touch_t.lcm has them.
// Ownership:    room for kMostContacts and kMostOthers; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      more contacts than there is room for are felt as they begin, and not further; a
//               hold takes the place of a touch. What another dancer does more often than is to be
//               felt of one is left out and counted, and takes nothing from a third one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/beat_clock.h"
#include "core/base/token_bucket.h"
#include "core/signal/haptic.h"
#include "core/signal/touch.h"

namespace dance {

class HapticSink {
 public:
  virtual ~HapticSink() = default;
  virtual void on_haptic(const Haptic& haptic) = 0;
};

// What is felt of the beat.
enum class FeltBeats : std::uint8_t { kNone, kOne, kAll };

struct HapticMakerOptions {
  bool touch = true;  // bodies that touch, holds that begin and end
  bool lead = true;   // what the partner's hand does in a hold
  FeltBeats beats = FeltBeats::kOne;
  std::vector<GuestId> from{};  // whose touches and holds; empty: everybody's
};

class HapticMaker {
 public:
  // Of all others, of one of them, and those at a time whose signals are counted apart.
  static constexpr std::size_t kMostContacts = 64, kMostOfOne = 16, kMostOthers = 16;
  // A beat is ordered so long before it is heard: longer than devices are late.
  static constexpr Duration kAhead = Duration::ms(400);
  // A contact that lasts is felt so often, ever less.
  static constexpr Duration kAgain = Duration::ms(120);
  static constexpr Duration kFades = Duration::ms(600);
  // A hand that moves faster than this in a hold is a signal of the lead; at most one in kBetween.
  static constexpr float kSignal_m_s = 0.6f;
  static constexpr Duration kBetween = Duration::ms(300);
  // Of touches one is felt at one place within kBetweenAtPlace; of one dancer's holds, and of its
  // lead, as well.
  static constexpr Duration kBetweenAtPlace = Duration::ms(100);
  // So many a second, and so many at once: of one dancer's touches, of its holds and lead, and of
  // the touches of all.
  static constexpr double kTouches_hz = 15.0, kTouchesAtOnce = 12.0;
  static constexpr double kHolds_hz = 8.0, kHoldsAtOnce = 6.0;
  static constexpr double kAllTouches_hz = 45.0, kAllTouchesAtOnce = 36.0;

  HapticMaker(HapticMakerOptions options, std::uint64_t maker, std::uint64_t clock_id)
      : options_(std::move(options)), maker_(maker), clock_id_(clock_id) {}

  void take(const Touch& touch, MonoTime now, HapticSink& sink);
  void hear(const Beat& beat) { music_.hear(beat); }
  // Orders the beats that come soon; to be called at least five times a second.
  void look_ahead(MonoTime now, HapticSink& sink);
  // Orders that were too many.
  std::uint64_t left_out() const { return left_out_; }

 private:
  struct Contact {
    std::uint32_t number = 0;
    GuestId other;  // not set: a free place
    MonoTime begun, felt, said, heard;
    bool is_hold = false;
  };
  // Another dancer: what may be felt of it, and where its holds and its lead were felt last.
  struct Other {
    GuestId guest;  // not set: a free place
    MonoTime heard;
    TokenBucket touches{kTouches_hz, kTouchesAtOnce}, holds{kHolds_hz, kHoldsAtOnce};
    std::array<MonoTime, kBoneCount> hold_at{}, lead_at{};
  };
  // How a haptic is shaped.
  struct Shape {
    Duration duration, attack, release;
    float amplitude, frequency_hz;
  };

  Contact* place_of(const Touch& touch, MonoTime now);
  Other* other_of(const GuestId& guest, MonoTime now);
  void read_signal(const Touch& touch, Contact& contact, MonoTime now, HapticSink& sink);
  bool is_felt(const GuestId& other) const;
  // Whether what another dancer did may be felt now, at the touch's bone; counts it.
  bool admit(HapticSource source, const Touch& touch, MonoTime now);
  void order(HapticSource source, Bone bone, const Shape& shape, MonoTime play, MonoTime now,
             HapticSink& sink);

  HapticMakerOptions options_;
  std::uint64_t maker_, clock_id_;
  std::uint32_t made_ = 0;
  BeatClock music_;
  double next_beat_ = 0.0;
  bool has_beat_ = false;
  std::array<Contact, kMostContacts> contacts_{};
  std::array<Other, kMostOthers> others_{};
  std::array<MonoTime, kBoneCount> touched_at_{};
  TokenBucket all_touches_{kAllTouches_hz, kAllTouchesAtOnce};
  std::uint64_t left_out_ = 0;
};

}  // namespace dance
