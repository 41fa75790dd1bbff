// UsualPosture: what a dancer who walks about tells of mounts, without a T-pose: the usual height
// of the eyes, how each device is usually turned against where the dancer faces, and where it
// usually is from the head. Feet count while they stand.
//
// Units/frames: facing is the heading of the head, or that of the walk; metres.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. Little is known of a point that has been seen for less than kEnough.
#pragma once

#include "producers/trackers/tracker_mounts.h"

namespace dance {

class UsualPosture {
 public:
  static constexpr float kEnough_s = 8.0f;

  void add(const TrackerFrame& frame);
  void clear() { *this = UsualPosture(); }

  // Seconds in which the head moved, as on somebody who walks about; of all, and of what is
  // remembered of a point.
  float counted_s() const { return counted_s_; }
  float seen_s(TrackedPoint point) const { return seen_s_[index_of(point)]; }
  // The device against the head's place on the floor, turned by where the dancer faces.
  Place usual_place(TrackedPoint point) const;
  // Of the eyes, of a dancer who stands upright; 0 at first.
  float eyes_m() const { return eyes_m_; }

 private:
  void follow_facing(const TrackerFrame& frame, float seconds);
  bool counts(const TrackerFrame& frame, float seconds);
  void forget_sums();

  std::array<Eigen::Vector3f, kTrackedPointCount> position_sums_{zeros()};
  std::array<Eigen::Vector4f, kTrackedPointCount> rotation_sums_{zeros4()};
  std::array<Eigen::Vector3f, kTrackedPointCount> lately_m_{zeros()};
  std::array<float, kTrackedPointCount> seen_s_{};
  TrackerFrame before_;
  Eigen::Vector3f walk_m_s_ = Eigen::Vector3f::Zero();
  Eigen::Quaternionf R_WFacing_ = Eigen::Quaternionf::Identity();
  float eyes_m_ = 0.0f, eyes_of_sums_m_ = 0.0f, counted_s_ = 0.0f;
  float speed_m_s_ = 0.0f;  // of the head, lately
  bool began_ = false;

  static std::array<Eigen::Vector3f, kTrackedPointCount> zeros() {
    std::array<Eigen::Vector3f, kTrackedPointCount> a;
    a.fill(Eigen::Vector3f::Zero());
    return a;
  }
  static std::array<Eigen::Vector4f, kTrackedPointCount> zeros4() {
    std::array<Eigen::Vector4f, kTrackedPointCount> a;
    a.fill(Eigen::Vector4f::Zero());
    return a;
  }
};

}  // namespace dance
