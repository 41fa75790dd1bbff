// PoseFilter: the last question of the stage: how shall the dance look? Changes the pose that is
// shown, and hears of every pose that came.
//
// Units/frames: as core/pose/pose.h; `now` is this house's clock, poses carry the capture time of
//               the moment that they show.
// Ownership:    the flow owns its filters; they never allocate after construction.
// Threads:      none inside; one owner.
// Failure:      what a filter refuses it counts.
#pragma once

#include <cstdint>

#include "core/base/time.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "core/signal/flow_setting.h"
#include "core/signal/style.h"

namespace dance {

class PoseFilter {
 public:
  virtual ~PoseFilter() = default;
  // A pose has come, newer than the one before.
  virtual void observe(const Pose& /*pose*/, MonoTime /*now*/) {}
  // Once a picture: a body comes in, and a body goes out.
  virtual void apply(MonoTime now, Pose& pose) = 0;
  virtual void set_body(const Skeleton& /*skeleton*/) {}
  // How the dancer wants to be shown.
  virtual void set_style(const Style& /*style*/) {}
  // How the session file, or a person at this stage, wants it. A filter reads the part of its own
  // word; where that is off, it changes nothing.
  virtual void set(const FlowSetting& /*setting*/) {}
  virtual std::uint64_t refused() const { return 0; }
  virtual std::uint64_t restarts() const { return 0; }
};

}  // namespace dance
