// CoupleScene: two dancers before one simulated camera, and what the networks would see of them:
// who hides whose joints is computed from their bodies, as are the colours of their clothes. A
// network that looks for the one behind sees the one before, unless that one is taken out of the
// picture; of hidden points it guesses, and takes a partner's arm for the dancer's own now and
// then.
//
// Units/frames: as testing/camera/capture_scene.h; both dancers in one C, each in a W of its own.
// Ownership:    owns its scenes; find() is good until the next call.
// Threads:      none inside.
// Failure:      none; the same seed gives the same.
#pragma once

#include <span>
#include <string>

#include "core/base/random.h"
#include "producers/camera/people/people_vision.h"
#include "testing/camera/capture_scene.h"

namespace dance {

struct CoupleDancer {
  Skeleton skeleton;
  std::vector<Pose> poses;
  // Of trunk, thighs, shanks and arms.
  std::array<PictureColour, 4> clothes;
};
struct CoupleErrors {
  SceneErrors network;
  double colour_sd = 0.03;  // light and noise
  // How often an arm that is near the partner's is taken for it, while it is hidden, and how long.
  double takes_arms_per_s = 1.5, takes_arm_for_s = 0.3;
};

class CoupleScene final : public PeopleVision {
 public:
  // Both at `hz` and of one length.
  CoupleScene(const std::array<CoupleDancer, 2>& dancers, double hz, SceneCamera camera,
              const CoupleErrors& errors, std::uint64_t seed);

  std::size_t frames() const { return scenes_[0].frames.size(); }
  MonoTime time(std::size_t frame) const { return scenes_[0].frames[frame].landmarks.capture_time; }
  const CaptureScene& scene(std::size_t dancer) const { return scenes_[dancer]; }
  // The share of shoulders, elbows, wrists, hips, knees and ankles that the partner hides.
  double hidden(std::size_t frame, std::size_t dancer) const;
  // Whose body this is: the one whose shoulders and hips it is nearer to.
  std::size_t nearer(std::size_t frame, const SeenBody& body) const;
  // A wrist of one is within 0.25 m of a wrist of the other.
  bool is_in_hold(std::size_t frame) const;

  // The picture that is looked at.
  void show(std::size_t frame);
  std::span<const SeenPerson> find(std::span<const SeenBody* const> without) override;
  bool read(const BodyRegion& region, const OtherPeople& others, ReadBody& out) override;
  std::optional<PictureColour> colour(const Eigen::Vector2f& place_px) override;

 private:
  struct Bar {
    Eigen::Vector3d a_C, b_C;
    double radius_m = 0.0;
    std::size_t part = 0;
  };
  using Bars = std::array<Bar, 11>;
  Eigen::Vector3d point_C(std::size_t frame, std::size_t dancer, std::size_t landmark) const;
  Bars bars(std::size_t frame, std::size_t dancer) const;
  std::array<bool, kLandmarkCount> hidden_points(std::size_t frame, std::size_t dancer) const;
  BodyRegion region(std::size_t frame, std::size_t dancer) const;
  bool is_in_picture(const BodyRegion& body) const;
  bool is_in_front(std::size_t frame, std::size_t dancer) const;
  void take_arms(std::size_t dancer, SeenBody& body);

  std::array<CaptureScene, 2> scenes_;
  std::array<std::array<PictureColour, 4>, 2> clothes_;
  CoupleErrors errors_;
  Random random_;
  std::size_t frame_ = 0;
  std::array<Bars, 2> bars_;                                     // of this frame
  std::array<std::array<bool, kLandmarkCount>, 2> is_hidden_{};  // in it
  std::array<SeenPerson, 2> people_;
  // Until when an arm (left, right) is taken for the partner's.
  std::array<std::array<double, 2>, 2> taken_s_{};
};

}  // namespace dance
