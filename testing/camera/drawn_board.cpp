#include "testing/camera/drawn_board.h"

#include <cmath>

#include "core/base/random.h"
#include "producers/camera/lens.h"

namespace dance {
namespace {

// Grey level where a ray meets the plane: squares, their white rim, and the room behind.
double level_at(const BoardShape& shape, const BoardPlace& place, const Eigen::Vector2d& straight) {
  const Eigen::Vector3d ray = place.R_CB.transpose() * straight.homogeneous();
  const Eigen::Vector3d from = place.R_CB.transpose() * -place.p_CB_m;
  const double t = -from.z() / ray.z();
  const double side = 1e-3 * shape.square_mm;
  const double x = (from.x() + t * ray.x()) / side + 1.0;
  const double y = (from.y() + t * ray.y()) / side + 1.0;
  if (t <= 0.0 || x < -0.8 || y < -0.8 || x > shape.columns + 1.8 || y > shape.rows + 1.8)
    return 90.0 + 20.0 * std::sin(straight.x() * 9.0);
  if (x < 0.0 || y < 0.0 || x > shape.columns + 1.0 || y > shape.rows + 1.0) return 225.0;
  const bool is_white = (static_cast<int>(x) + static_cast<int>(y)) % 2 == 0;
  return is_white ? 225.0 : 25.0;
}

}  // namespace

DrawnBoardPainter::DrawnBoardPainter(const Pinhole& camera) : camera_(camera) {
  for (int v = 0; v <= camera.height_px; ++v)
    for (int u = 0; u <= camera.width_px; ++u)
      corner_rays_.push_back(undistorted(camera, {u - 0.5, v - 0.5}));
}

cv::Mat DrawnBoardPainter::draw(const BoardShape& shape, const BoardPlace& place,
                                std::uint64_t seed) const {
  constexpr int kFine = 3;
  cv::Mat out(camera_.height_px, camera_.width_px, CV_8UC1);
  Random random(seed);
  const auto line = static_cast<std::size_t>(camera_.width_px + 1);
  for (int v = 0; v < out.rows; ++v)
    for (int u = 0; u < out.cols; ++u) {
      const Eigen::Vector2d* at =
          corner_rays_.data() + static_cast<std::size_t>(v) * line + static_cast<std::size_t>(u);
      double sum = 0.0;
      for (int i = 0; i < kFine * kFine; ++i) {
        const double x = (i % kFine + 0.5) / kFine;
        const double y = (i / kFine + 0.5) / kFine;
        const Eigen::Vector2d straight = (1.0 - y) * ((1.0 - x) * at[0] + x * at[1]) +
                                         y * ((1.0 - x) * at[line] + x * at[line + 1]);
        sum += level_at(shape, place, straight);
      }
      out.at<std::uint8_t>(v, u) =
          cv::saturate_cast<std::uint8_t>(sum / (kFine * kFine) + 2.0 * random.normal());
    }
  return out;
}

std::vector<BoardPlace> ways_to_hold(const Pinhole& camera, const BoardShape& shape) {
  std::vector<BoardPlace> out;
  const double width_m = 1e-3 * shape.square_mm * (shape.columns + 1);
  const double height_m = 1e-3 * shape.square_mm * (shape.rows + 1);
  // Distance at which the board fills this part of the picture's width.
  const auto distance = [&](double part) {
    return camera.fx_px * width_m / (part * camera.width_px);
  };
  const auto hold = [&](double u, double v, double part, double lean, double pitch, double roll) {
    const double z = distance(part);
    const Eigen::Vector3d middle((u - 0.5) * camera.width_px / camera.fx_px * z,
                                 (v - 0.5) * camera.height_px / camera.fy_px * z, z);
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    const double side = 1e-3 * shape.square_mm;
    out.push_back(
        {turn, middle - turn * Eigen::Vector3d(0.5 * width_m - side, 0.5 * height_m - side, 0.0)});
  };
  // Four leans near, four corners and edges farther away.
  hold(0.50, 0.50, 0.62, 0.0, 0.0, 0.0);
  hold(0.48, 0.50, 0.70, 0.55, 0.0, 0.05);
  hold(0.52, 0.50, 0.70, -0.55, 0.0, -0.05);
  hold(0.50, 0.48, 0.64, 0.0, 0.6, 0.02);
  hold(0.50, 0.52, 0.64, 0.0, -0.6, -0.02);
  hold(0.25, 0.27, 0.40, 0.35, -0.35, 0.1);
  hold(0.75, 0.27, 0.40, -0.35, -0.35, -0.1);
  hold(0.25, 0.73, 0.40, 0.35, 0.35, -0.1);
  hold(0.75, 0.73, 0.40, -0.35, 0.35, 0.1);
  hold(0.50, 0.25, 0.38, 0.1, -0.5, 0.3);
  hold(0.50, 0.75, 0.38, -0.1, 0.5, -0.3);
  hold(0.22, 0.50, 0.36, 0.5, 0.1, 0.2);
  hold(0.78, 0.50, 0.36, -0.5, -0.1, -0.2);
  hold(0.50, 0.50, 0.30, 0.3, 0.3, 0.7);
  return out;
}

BoardPlace in_right_eye(const StereoRig& rig, const BoardPlace& left) {
  return {rig.R_RL * left.R_CB, rig.R_RL * left.p_CB_m + rig.p_RL_m};
}

}  // namespace dance
