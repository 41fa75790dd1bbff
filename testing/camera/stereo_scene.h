// StereoScene: a dancer in a room as a rig of two cameras sees them, drawn with known truth:
// patterned capsules before a patterned wall, through each eye's own lens, with the eyes' noise,
// blur and difference of exposure. For judging what only the truth can judge.
//
// Units/frames: metres and pixels; S is the scene's frame: x right, y down, z away, that of the raw
//               left camera.
// Ownership:    keeps tables of rays per eye and the pictures' buffers.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "producers/camera/stereo/rectified_pair.h"

namespace dance {

// A capsule between two points whose cross-section is an ellipse: `half_m` along `aside`, `half_m ·
// flatness` across that.
struct SceneLimb {
  Eigen::Vector3d from_m;
  Eigen::Vector3d to_m;
  Eigen::Vector3d aside = Eigen::Vector3d::UnitX();
  double half_m = 0.05;
  double flatness = 1.0;
  double brightness = 120.0;  // grey level
  double contrast = 30.0;     // deviation of its pattern, grey levels
  std::uint32_t pattern = 0;
};

struct SceneEyes {
  double noise = 3.0;           // deviation, grey levels
  double blur_px = 0.7;         // of the lens, standard deviation
  double right_gain = 1.12;     // the right eye's exposure over the left's
  double right_offset = 4.0;    // grey levels
  double wall_m = 5.0;          // behind the left camera
  double wall_contrast = 25.0;  // as SceneLimb::contrast
};

class StereoScene {
 public:
  StereoScene(const StereoRig& rig, const SceneEyes& eyes, std::uint64_t seed);

  // Both pictures, blue green red, of the rig's size.
  void draw(std::span<const SceneLimb> limbs, cv::Mat& left, cv::Mat& right) {
    draw(limbs, limbs, left, right);
  }
  // Eyes that open at different moments.
  void draw(std::span<const SceneLimb> limbs, std::span<const SceneLimb> limbs_of_right,
            cv::Mat& left, cv::Mat& right);
  const StereoRig& rig() const { return rig_; }

 private:
  struct Ray {
    float x;
    float y;
  };
  void draw_eye(Side side, std::span<const SceneLimb> limbs, cv::Mat& out);
  void draw_wall(Side side);
  void draw_limb(Side side, const SceneLimb& limb);
  cv::Rect box_of(Side side, const SceneLimb& limb) const;
  void finish(Side side, cv::Mat& out);

  StereoRig rig_;
  SceneEyes eyes_;
  std::uint64_t seed_;
  std::uint64_t frame_ = 0;
  std::vector<Ray> rays_[2];
  // 1/z along the ray, so that 0 is nothing; grey levels.
  cv::Mat_<float> depth_;
  cv::Mat_<float> colour_;
  cv::Mat_<float> wall_depth_[2];
  cv::Mat_<float> wall_colour_[2];
};

// Smooth noise with details of about `grain_m`: mean 0, deviation about 1, the same each time.
double pattern_at(const Eigen::Vector3d& p_m, double grain_m, std::uint32_t pattern);

}  // namespace dance
