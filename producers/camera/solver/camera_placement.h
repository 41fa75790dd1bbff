// CameraPlacement: where the camera stands over the floor and how it is tilted, learned from feet
// that stand and from how upright people are.
//
// Units/frames: C as in producers/camera/pinhole.h; W has the floor at y = 0, +z from the dancer's
//               first place towards the camera, the origin on the floor where the dancer was first.
//               The floor in C: y = h + a x + b z.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      none: what is learned stays within bounds (camera 0.1 m to 5 m high, tilted by 45°
//               at most, leaning by 17°), and the prior of a typical camera replaces missing
//               observations.
// Source:       each standing foot gives y/z = h/z + a x/z + b, whose left side a picture measures
//               best. Where nobody walks nearer or away, feet do not separate h from b; there the
//               body's mean upright direction decides.
#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace dance {

class CameraPlacement {
 public:
  CameraPlacement() { reset(); }
  void reset();

  // The body's axis, from ankles to shoulders, of a moment; any length.
  void add_upright(const Eigen::Vector3d& up_C);
  // The sole of a foot that stands, where the picture alone puts it.
  void add_foot(const Eigen::Vector3d& p_C_m);
  // Drops the observations of feet: the floor was wrong.
  void discard_feet();
  // The same where depth is measured better from now on: the floor is about where it was.
  void relearn_floor();
  // Before any foot was seen to stand: this point is about on the floor.
  void set_initial_floor(const Eigen::Vector3d& lowest_C_m);
  // The place that is W's origin once it is put onto the floor.
  void set_origin(const Eigen::Vector3d& p_C_m) {
    origin_C_m_ = p_C_m;
    place();
  }
  // Multiplies all lengths by `by`.
  void scale(double by);
  // By what a body has to grow, seen as it is, so that this point of it is on the floor.
  std::optional<double> growth_to_floor(const Eigen::Vector3d& p_C_m) const;
  // Solves for the placement with all observations.
  void update();

  bool is_known() const { return feet_ >= kKnown; }
  bool is_settled() const { return feet_ >= kSettled; }
  double height_m() const { return height_m_; }
  // Positive: it looks down.
  double pitch_rad() const;

  const Eigen::Matrix3d& R_WC() const { return R_WC_; }
  Eigen::Vector3d to_W(const Eigen::Vector3d& p_C_m) const { return R_WC_ * p_C_m + p_WC_m_; }
  Eigen::Vector3d to_C(const Eigen::Vector3d& p_W_m) const {
    return R_WC_.transpose() * (p_W_m - p_WC_m_);
  }

 private:
  static constexpr int kKnown = 12, kSettled = 90;
  void place();

  // Of (h, a, b): J^T W J and J^T W r of the observations, old ones fading.
  Eigen::Matrix3d feet_information_;
  Eigen::Vector3d feet_sum_;
  double feet_weight_ = 0.0;
  Eigen::Vector3d up_sum_C_;
  int feet_ = 0, ups_ = 0, refused_ = 0;
  double initial_h_m_ = 1.2;
  Eigen::Vector3d plane_;  // h, a, b
  Eigen::Vector3d origin_C_m_;
  Eigen::Matrix3d R_WC_;
  Eigen::Vector3d p_WC_m_;
  double height_m_ = 1.2;
};

}  // namespace dance
