// SoleContacts: which heels and balls stand on the floor, and where. A sole that is near the floor
// and hardly moves stands; it is held where it came down until it rises, or is observed elsewhere.
//
// Units/frames: metres in W, floor at y = 0; seconds.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      a hidden sole stays in contact for a moment and is then released.
#pragma once

#include <array>

#include "producers/camera/solver/body_fit.h"
#include "producers/camera/solver/body_model.h"
#include "producers/camera/solver/camera_placement.h"
#include "producers/camera/solver/observation.h"

namespace dance {

class SoleContacts {
 public:
  void clear();
  // After a fit. Before the floor is known the lower foot is taken to be near it.
  void follow(const BodyModel& body, const Observation& seen, const CameraPlacement& camera,
              double seconds);
  // The same soles in another W, or another scale.
  template <class Move>
  void rebase(Move move_place) {
    for (Foot& sole : soles_) {
      sole.touch.held_W_m = move_place(sole.touch.held_W_m);
      sole.touch.held_W_m.y() = 0.0;
      sole.seen_W_m = move_place(sole.seen_W_m);
    }
  }

  const SoleTouch& touch(std::size_t sole) const { return soles_[sole].touch; }
  // Where the picture alone has a sole.
  const Eigen::Vector3d& seen_W_m(std::size_t sole) const { return soles_[sole].seen_W_m; }

 private:
  struct Foot {
    SoleTouch touch;
    Eigen::Vector3d seen_W_m = Eigen::Vector3d::Zero();
    Eigen::Vector2d ray = Eigen::Vector2d::Zero();       // of the place, in C
    Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  // m/s across the view
    double hidden_s = 0.0;
    bool is_new = true;
  };
  std::array<Foot, kSoleCount> soles_;
};

}  // namespace dance
