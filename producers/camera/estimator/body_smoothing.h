// BodySmoothing: removes jitter from the network's landmarks, as MediaPipe does, at the cost of
// some delay in slow motion.
//
// Units/frames: as producers/camera/estimator/landmark_network.h says.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none; a time that is not later than the last one changes nothing in the filters and
//               smooths nothing.
// Source:       settings of the filters, and which of them begin anew: MediaPipe's graph of pose
//               landmark filtering.
#pragma once

#include <array>
#include <optional>

#include "core/base/time.h"
#include "producers/camera/estimator/landmark_network.h"
#include "producers/camera/estimator/one_euro.h"

namespace dance {

class BodySmoothing {
 public:
  // With `only_region` the points are left as they are; where the body is looked for next is always
  // steadied.
  void smooth(MonoTime now, bool only_region, SeenBody& body);
  // After a picture without the body: filters of points in pixels begin anew; those of metres and
  // of visibility go on, as in the original, whose filters of these do not run without a body.
  void lose();
  // Another body, or another camera.
  void reset();

 private:
  std::optional<MonoTime> last_;
  std::array<std::array<OneEuro, 3>, kLandmarkCount> image_;
  std::array<std::array<OneEuro, 3>, kLandmarkCount> world_;
  std::array<std::array<OneEuro, 2>, 2> next_;
  std::array<float, kLandmarkCount> visibility_{};
};

}  // namespace dance
