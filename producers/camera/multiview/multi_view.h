// MultiView: several ordinary cameras around one dancer, as the solver wants them: for each picture
// of the first camera the newest that the others saw, with where they stand. No picture of the
// first waits for another camera's.
//
// Units/frames: each camera's pixels and stamps; C the first camera's frame.
// Ownership:    a CameraPair for each further camera; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      a camera that is not placed yet, or whose newest picture is too old, is left out of
//               the views; its share comes and goes within a second.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "producers/camera/body_landmarks.h"
#include "producers/camera/multiview/camera_pair.h"
#include "producers/camera/pinhole.h"
#include "producers/camera/solver/joint/other_view.h"

namespace dance {

class MultiView {
 public:
  explicit MultiView(const Pinhole& first) : first_(first) {}
  // At most kMostOtherViews; they are counted from 0.
  void add_camera(const Pinhole& camera);

  void see_other(std::size_t camera, const BodyLandmarks& body);
  // The views that belong to this picture of the first camera; good until the next call.
  OtherViews see_first(const BodyLandmarks& body, const DancerSize& size);
  // Lengths of the body that two cameras measured, once after each placement.
  std::optional<BodyLengths> take_lengths();

  // Another dancer: placements stay, lengths are measured again.
  void reset_body() {
    for (const auto& other : others_) other->pair.reset_body();
  }
  const CameraPair& pair(std::size_t camera) const { return others_[camera]->pair; }
  // The first camera's lens, as pictures have another size.
  void set_first(const Pinhole& first) { first_ = first; }

 private:
  struct Other {
    Pinhole lens;
    CameraPair pair;
    Observation seen;
    MonoTime seen_time;
    double trust = 0.0;  // rises while it is placed and seen
    MonoTime trust_time;
  };
  bool write_view(Other& other, MonoTime now, OtherView& out);

  Pinhole first_;
  std::vector<std::unique_ptr<Other>> others_;
  std::array<OtherView, kMostOtherViews> views_;
};

}  // namespace dance
