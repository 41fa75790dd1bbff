// StageHolds: which hands of the dancers on a stage hold each other, kept through jitter and
// prediction errors; and, where a route has the word hold-hands, arms that reach the last
// centimetres, each of the two dancers half of the way.
//
// Units/frames: metres in W; times of this house's clock. Palms as core/motion/palm_pull.h has
//               them.
// Ownership:    room for kMostDancers, those of this house first, then those nearest to them; hands
//               of two remote dancers hold where places are left. Never allocates after
//               construction.
// Threads:      none inside; one owner.
// Failure:      more dancers than there is room for are shown as they are, and their poses counted.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/guest_id.h"
#include "core/pose/kinematics.h"
#include "transformers/touch/palm_hold.h"
#include "transformers/touch/stage_places.h"

namespace dance {

class StageHolds {
 public:
  static constexpr std::size_t kMostDancers = 16;
  // Who was not shown for so long holds nobody.
  static constexpr Duration kGone = Duration::ms(500);

  StageHolds();
  void set_limits(const PalmHold::Limits& limits) { limits_ = limits; }
  void set_body(const GuestId& guest, const Skeleton& skeleton);
  // A pose that is about to be shown. With `reaches`, its arms are moved to the hands they hold;
  // returns whether they were.
  bool show(const GuestId& guest, Pose& pose, MonoTime now, bool reaches, DancerOf of);
  // Dances here, and was shown.
  bool is_of_this_house(const GuestId& guest) const {
    const Dancer* dancer = find(guest);
    return dancer && dancer->of == DancerOf::kThisHouse;
  }

  bool are_held(const GuestId& first, std::size_t first_side, const GuestId& second,
                std::size_t second_side) const;
  // Poses of dancers who had no place.
  std::uint64_t refused() const { return refused_; }

 private:
  using Palms = std::array<Eigen::Vector3f, 2>;
  // Of two dancers: the first's palm k / 2, the second's k % 2.
  using Pair = std::array<PalmHold, 4>;
  struct Dancer : StagePlace {
    Skeleton skeleton;
    Palms palms, speed_m_s;  // as shown, before arms reach
    bool reaches = false;
    Eigen::Vector3f palm_at(std::size_t side, MonoTime now) const;
  };
  struct Reach {
    std::array<Eigen::Vector3f, 2> shift;
    std::array<float, 2> weight{};
  };

  Dancer* place_of(const GuestId& guest, const Pose& pose, MonoTime now, DancerOf of);
  const Dancer* find(const GuestId& guest) const;
  void note(Dancer& dancer, const Palms& palms, MonoTime now) const;
  void hold(std::size_t own, std::size_t other, MonoTime now, Reach& reach);
  void leave(std::size_t place);
  static std::size_t pair_index(std::size_t a, std::size_t b) { return b * (b - 1) / 2 + a; }
  const Pair& pair(std::size_t a, std::size_t b) const { return pairs_[pair_index(a, b)]; }

  PalmHold::Limits limits_;
  std::array<Dancer, kMostDancers> dancers_;
  std::array<Pair, kMostDancers*(kMostDancers - 1) / 2> pairs_;
  std::uint64_t refused_ = 0;
};

}  // namespace dance
