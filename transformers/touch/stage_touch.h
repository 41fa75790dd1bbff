// StageTouch: where and how the dancers of this house touch each other and remote ones, as they
// feel it; of two remote dancers nothing is said. Works on the poses as they are shown; held hands
// are those of StageHolds.
//
// Units/frames: as lcmtypes/touch_t.lcm says; times of this house's clock.
// Ownership:    room for kMostDancers, as StageHolds has it, and kMostPairs of them that touch at a
//               time; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      more dancers or pairs than there is room for do not touch, and are counted
//               with each pose and each look.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "core/signal/touch.h"
#include "transformers/touch/body_capsules.h"
#include "transformers/touch/stage_holds.h"

namespace dance {

class TouchSink {
 public:
  virtual ~TouchSink() = default;
  // As `guest`, who is of this house, feels it.
  virtual void on_touch(const GuestId& guest, const Touch& touch) = 0;
};

class StageTouch {
 public:
  static constexpr std::size_t kMostDancers = StageHolds::kMostDancers;
  static constexpr std::size_t kMostPairs = 24;
  static constexpr Duration kGone = StageHolds::kGone;
  // Bodies touch at an overlap of 0, and part at this distance.
  static constexpr float kParts_m = 0.025f;
  // Dancers whose hips are further apart are not looked at.
  static constexpr float kNear_m = 2.5f;
  // A contact that lasts is told so often.
  static constexpr Duration kTold = Duration::ms(33);

  StageTouch();
  ~StageTouch();
  void set_body(const GuestId& guest, const Skeleton& skeleton);
  // A pose as it is shown.
  void show(const GuestId& guest, const Pose& pose, MonoTime now, DancerOf of);
  // Looks at who touches whom now; to be called about sixty times a second.
  void update(MonoTime now, std::uint64_t clock_id, const StageHolds& holds, TouchSink& sink);

  std::uint64_t refused() const { return refused_; }

 private:
  struct Contact;
  struct Pair;
  struct Dancer;
  struct Found;
  struct State;

  using Slots = std::array<Found, kBodyParts * kBodyParts>;

  Dancer* place_of(const GuestId& guest, const Pose& pose, MonoTime now, DancerOf of);
  Pair* pair_of(std::size_t a, std::size_t b, bool wants_one);
  // Of each two parts of the body the bones that are deepest in each other; whether there are any.
  static bool look(const Dancer& a, const Dancer& b, const StageHolds& holds, Slots& found);
  void follow(Pair& pair, std::size_t slot, const Found& found, MonoTime now,
              std::uint64_t clock_id, TouchSink& sink);
  void tell(const Pair& pair, const Contact& contact, TouchPhase phase, MonoTime now,
            std::uint64_t clock_id, TouchSink& sink) const;
  void end(Pair& pair, MonoTime now, std::uint64_t clock_id, TouchSink& sink);

  std::unique_ptr<State> state_;
  std::uint32_t contacts_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace dance
