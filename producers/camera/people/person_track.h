// PersonTrack: one of several people before a camera: where the network looks for the body next,
// how it moves in the picture, and what it looks like.
//
// Units/frames: pixels as producers/camera/region/picture_region.h has them; times are those of
//               the frames.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>
#include <optional>

#include "core/base/time.h"
#include "producers/camera/estimator/body_smoothing.h"
#include "producers/camera/people/person_look.h"

namespace dance {

// By which bodies are compared; a right one follows each left one.
constexpr std::array<Landmark, 10> kBodyJoints{
    Landmark::kLeftShoulder, Landmark::kRightShoulder, Landmark::kLeftElbow, Landmark::kRightElbow,
    Landmark::kLeftHip,      Landmark::kRightHip,      Landmark::kLeftKnee,  Landmark::kRightKnee,
    Landmark::kLeftAnkle,    Landmark::kRightAnkle};

// Whether two regions have come to the same body.
bool are_one_body(const SeenBody& a, const SeenBody& b);

class PersonTrack {
 public:
  // Where the network is to look; none while the person is not tracked.
  const std::optional<BodyRegion>& next() const { return next_; }
  bool was_ever_seen() const { return seen_.is_set(); }
  MonoTime seen() const { return seen_; }
  // The last region, and where its middle is expected now: the speed fades within half a second.
  const BodyRegion& region() const { return region_; }
  Eigen::Vector2f expected_px(MonoTime now) const;
  // Whether the person can be in this region now.
  bool is_plausible(const BodyRegion& region, MonoTime now) const;

  // The last body, moved to where it is expected now. None where it says nothing any more.
  std::optional<SeenBody> expected_body(MonoTime now) const;
  // How far a body's joints are from where the last one's are expected now, the mean in lengths of
  // its measure; sides exchanged where that is nearer. None as above.
  std::optional<float> off_course(const SeenBody& body, MonoTime now) const;

  // The body that was read in a picture; steadies where it is looked for next.
  void update(const SeenBody& body, MonoTime now);
  void lose();
  // Somebody else.
  void reset() { *this = {}; }

  LookModel look;

 private:
  std::optional<BodyRegion> next_;
  BodyRegion region_;
  SeenBody body_;
  Eigen::Vector2f speed_px_s_ = Eigen::Vector2f::Zero();
  MonoTime seen_;
  bool is_begun_ = false;  // the speed is of pictures without a gap
  BodySmoothing smoothing_;
};

}  // namespace dance
