// ViewCoupleFinder: finds pairs of dancers for the camera by their positions: each is the nearest
// of the other, and near. A couple ends only when the two have clearly parted, so that a grid of
// couples does not flicker.
//
// Units/frames: metres in W.
// Ownership:    remembers the couples; allocates when guests come or go.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none.
#pragma once

#include <utility>
#include <vector>

#include "viewer/scene/scene.h"

namespace dance {

class ViewCoupleFinder {
 public:
  static constexpr float kTogether_m = 1.3f;
  static constexpr float kParted_m = 2.2f;
  // A step aside is not yet a parting.
  static constexpr Duration kPartingTakes = Duration::s(2);

  // One or two guests of scene.guests each, by index, in the order of the first one.
  const std::vector<std::vector<std::size_t>>& groups(const SceneState& scene);

 private:
  struct Couple {
    GuestId first, second;
    MonoTime last_together;
  };
  std::vector<Couple> couples_;
  std::vector<std::vector<std::size_t>> groups_;
};

}  // namespace dance
