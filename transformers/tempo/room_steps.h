// RoomSteps: the tempo at which the people of a room step, from their poses as they were captured:
// of those who dance in this house, and only where nobody does of the room's other guests, who hear
// the music at another time but at the same tempo.
//
// What is fitted to the music or moved by it proves nothing about the music: poses of a stage do
// not belong here, the musical time that poses carry is passed over, a producer that moves its
// dancer to the beats that a tracker told says so with tell(), and of the music that is heard
// nothing is asked but where to look (transformers/tempo/step_level.h).
//
// Units/frames: steps a minute; times of this house's clock.
// Ownership:    keeps what it knows of kMostDancers dancers, 1.5 MB; allocates nothing after
//               construction.
// Threads:      none inside; one owner.
// Failure:      pass() returns nothing while nobody steps, or while they do not agree.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/beat_clock.h"
#include "core/base/guest_id.h"
#include "core/base/steps.h"
#include "core/pose/pose.h"
#include "transformers/tempo/step_level.h"
#include "transformers/tempo/step_tempo.h"

namespace dance {

class RoomSteps {
 public:
  enum class Whose : std::uint8_t { kOwn, kRemote };
  // So many are watched: dancers of this house first, then who came first.
  static constexpr std::size_t kMostDancers = 8;
  // Who sends nothing for so long does not dance; nor is a producer believed for longer.
  static constexpr Duration kSilence = Duration::s(3);
  // A figure hides the steps for some seconds: what was seen before holds for so long.
  static constexpr Duration kHeld = Duration::s(12);
  // Less is not worth saying.
  static constexpr double kLeastWeight = 0.2;

  RoomSteps();

  // Poses of each dancer in the order of their capture.
  void observe(Whose whose, const GuestId& guest, const Pose& pose, MonoTime now);
  void set_body(Whose whose, const GuestId& guest, const Skeleton& skeleton);
  // The music of this house.
  void hear(const Beat& beat) { music_.hear(beat); }
  // What a producer of this house says of its dancer: it is believed instead of the poses.
  void tell(const GuestId& guest, const Steps& steps, MonoTime now);
  // Some times a second: what is known now, without its stamp. With eight dancers 0.3 ms.
  std::optional<Steps> pass(MonoTime now);

 private:
  struct Dancer {
    GuestId guest;  // not set: free
    Whose whose = Whose::kOwn;
    MonoTime heard, told_at;
    Steps told;
    StepLevel level;
  };
  // Of all in this house, or of all others.
  struct Group {
    StepTempo tempo;
    MonoTime stepped;  // when somebody last did
    int present = 0;   // who are seen
    int dancers = 0;   // of them, who step now
  };

  Dancer* dancer_of(Whose whose, const GuestId& guest, MonoTime now);
  static void see(const Dancer& dancer, Group& group, MonoTime now);
  static bool is_stepping(const Group& group, MonoTime now);
  static std::optional<Steps> steps_of(const Group& group, MonoTime now);

  std::vector<Dancer> dancers_;
  Group own_, remote_;
  BeatClock music_;
  MonoTime passed_;
  Pose seen_;
};

}  // namespace dance
