// What the tests of the router put on its stage, and its routes.
//
// Units/frames: as manager/router.h.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include <utility>
#include <vector>

#include "manager/router.h"
#include "tests/manager/poses.h"

namespace dance {

struct Stage : StageSink {
  void stage(const GuestId& g, Pose& pose, MonoTime) override {
    if (keep) poses.push_back({g, pose});
    ++count;
  }
  void stage(const GuestId& g, const Hands& h) override {
    hands.push_back(g);
    fingers.push_back(h);
  }
  void stage(const GuestId& g, const TimedSkeleton&) override { skeletons.push_back(g); }

  std::vector<std::pair<GuestId, Pose>> poses;
  std::vector<GuestId> hands;
  std::vector<Hands> fingers;
  std::vector<GuestId> skeletons;
  int count = 0;
  bool keep = true;
};

inline Route pass_through(Where from, const char* from_guest = nullptr,
                          const char* to_guest = nullptr) {
  Route route;
  route.from.where = from;
  route.to.where = Where::kStage;
  if (from_guest) route.from.guest = guest(from_guest);
  if (to_guest) route.to.guest = guest(to_guest);
  return route;
}

inline Route held(const char* specification) {
  Route route = pass_through(Where::kGuest);
  route.through = {specification};
  route.rate_hz = 60.0;
  return route;
}

}  // namespace dance
