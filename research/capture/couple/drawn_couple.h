// DrawnCouple: two recorded dancers drawn as avatars by the viewer's own renderer before a camera,
// whose pictures the real networks see and whose truth is known.
//
// Units/frames: truth in metres, W of the takes turned so that +z points to the camera; pixels as
//               producers/camera/body_landmarks.h has them.
// Ownership:    owns the OpenGL context and what is drawn. picture() is good until the next call.
// Threads:      one; the context is current on it.
// Failure:      open() names the file, or what is missing to draw without a display.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "core/pose/kinematics.h"
#include "producers/camera/pinhole.h"
#include "research/capture/capture_solve_eval.h"
#include "research/codec_takes.h"

namespace dance {

struct CoupleView {
  int width_px = 960, height_px = 540;
  double fov_deg = 65.0;  // across, as of a webcam
  double yaw_deg = 0.0;   // from where it looks
  double distance_m = 4.2;
  double height_m = 1.2;
  double pitch_rad = 0.06;            // it looks down
  std::array<std::string, 2> avatar;  // files; "" draws mannequins
  std::string pictures;  // a folder that keeps pictures from one run to the next; "" keeps none
};

struct CoupleTruth {
  std::array<LimbPlaces, 2> joint_W_m;
  std::array<std::array<Eigen::Vector2d, kJudgedCount>, 2> joint_px;
  // The share of a dancer's joints that the partner's body hides.
  std::array<double, 2> hidden{};
  bool is_in_hold = false;  // a wrist of one is within 0.25 m of a wrist of the other
};

class DrawnCouple {
 public:
  // Both takes at the same rate, of the same evening.
  static Result<std::unique_ptr<DrawnCouple>> open(const CodecTake& lead, const CodecTake& follow,
                                                   const CoupleView& view);
  ~DrawnCouple();

  std::size_t frames() const;
  double hz() const;
  const Pinhole& pinhole() const;
  const std::string& name() const;
  const CoupleTruth& truth(std::size_t frame) const;
  // With both, or with one of the two alone.
  enum class Who { kBoth, kLead, kFollow };
  Result<cv::Mat> picture(std::size_t frame, Who who);

 private:
  class Inside;
  explicit DrawnCouple(std::unique_ptr<Inside> inside);
  std::unique_ptr<Inside> inside_;
};

}  // namespace dance
