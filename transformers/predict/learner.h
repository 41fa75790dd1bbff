// Learner: what a transformer learns of its dancer beside the pose path: the heavy part, for a
// thread that has time.
//
// Units/frames: as the transformer's.
// Ownership:    shared by the transformer, which may go at any moment, and the thread that learns.
// Threads:      learn() runs in one other thread than the transformer's; the two meet in
//               core/base/spsc_ring.h (what was seen) and core/base/latest.h (what was learned) and
//               nowhere else.
// Failure:      none; a learner that is never run leaves the transformer as it was.
#pragma once

namespace dance {

class Learner {
 public:
  virtual ~Learner() = default;
  // Takes in what was seen since the last call, and learns when there is enough of it. Called a few
  // times a second; may take a tenth of a second and may allocate.
  virtual void learn() = 0;
};

}  // namespace dance
