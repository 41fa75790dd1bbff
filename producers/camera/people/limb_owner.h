// LimbOwner: whose limb it is where the network gives the same arm or leg of a picture to two
// people: a partner's arm is not taken for one's own. The owner is who expected a limb there, whose
// bones are long enough, and who is not behind the other's trunk; for the other it counts as
// hidden.
//
// Units/frames: pixels of the picture.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none; in doubt both keep it, as hands that hold each other are in one place.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/base/time.h"
#include "producers/camera/estimator/landmark_network.h"

namespace dance {

// A person's limbs as they moved so far.
class LimbMotion {
 public:
  static constexpr std::size_t kLimbs = 4;  // left and right arm, left and right leg
  // The outer ends of a limb's two bones: elbow and wrist, knee and ankle.
  struct Ends {
    std::array<Eigen::Vector2f, 2> place_px;
  };

  // What was accepted of the picture; hidden limbs keep their place beside the trunk.
  void update(const SeenBody& body, MonoTime now);
  // Where this body's limb is expected, by its motion beside the trunk.
  Ends expected(const SeenBody& body, std::size_t limb, MonoTime now) const;
  // And seen lately.
  bool is_known(std::size_t limb, MonoTime now) const {
    return limbs_[limb].pictures >= kKnown && now - limbs_[limb].seen < Duration::s(1);
  }
  // By how much each of the limb's two bones is longer than it ever was, as a share of that; 0: it
  // is not.
  std::array<float, 2> excess(const SeenBody& body, std::size_t limb) const;
  void reset() { *this = {}; }

 private:
  static constexpr int kKnown = 5;
  struct Limb {
    Ends place;  // from the hip or shoulder, in lengths of the body's measure
    Ends speed;  // a second
    std::array<float, 2> longest{};
    MonoTime seen;
    int pictures = 0;
  };
  std::array<Limb, kLimbs> limbs_;
};

struct LimbClaimant {
  SeenBody* body = nullptr;  // null: not seen in this picture
  const LimbMotion* motion = nullptr;
  bool is_in_front = false;  // of all others: nearer to the camera
};
// Marks as hidden, in each of the bodies, the limbs that are another's. Returns how many these are.
int resolve_limbs(std::span<const LimbClaimant> people, MonoTime now);

}  // namespace dance
