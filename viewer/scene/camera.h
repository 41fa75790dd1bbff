// The camera that looks at the stage, as pure maths: an orbit round a point, where that point must
// be so that all dancers are in the picture, and where a point of W falls on the screen.
//
// Units/frames: W; yaw 0 looks along -Z (at the face of a dancer in T-pose), yaw grows to the
//               dancer's left; pitch is positive from above. Pixels count from the top left.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; framing no points leaves the camera as it was.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace dance {

struct OrbitCamera {
  Eigen::Vector3f target_W_m{0.0f, 0.95f, 0.0f};
  float yaw_rad = 0.6f;
  float pitch_rad = 0.16f;
  float distance_m = 4.5f;
  float fov_y_rad = 0.62f;  // narrow, so that people at the sides keep their proportions
  // The finished picture is turned round, left for right, before anything is written on it; the
  // matrices below do not know of it, project() does.
  bool is_mirrored = false;

  Eigen::Vector3f eye_W_m() const;
  // Columns: right, up and backward of the camera in W.
  Eigen::Matrix3f axes_W() const;
  Eigen::Matrix4f view_from_world() const;
  Eigen::Matrix4f clip_from_view(float aspect) const;
  Eigen::Matrix4f clip_from_world(float aspect) const {
    return clip_from_view(aspect) * view_from_world();
  }
};

// What drawing needs of whatever looks at the stage: a camera, or an eye in a headset.
struct StageEye {
  Eigen::Vector3f eye_W_m = Eigen::Vector3f::Zero();
  Eigen::Matrix4f view_from_world = Eigen::Matrix4f::Identity();
  Eigen::Matrix4f clip_from_world = Eigen::Matrix4f::Identity();
  float px_at_1m = 1000.0f;  // pixels of a metre that is a metre away
};
StageEye eye_of(const OrbitCamera& camera, int width_px, int height_px);

// Half the opening of an eye's picture to each side, as tangents; left and down are negative.
struct EyeTangents {
  float left, right, up, down;
};
// R_WE's columns: right, up and backward of the eye.
StageEye eye_at(const Eigen::Vector3f& eye_W_m, const Eigen::Matrix3f& R_WE,
                const EyeTangents& tangents, int height_px);

struct ScreenPoint {
  float x_px = 0.0f;
  float y_px = 0.0f;
  float depth_m = 0.0f;  // along the view direction
};

// Where p_W lies on a screen of that size; nullopt behind the camera.
std::optional<ScreenPoint> project(const OrbitCamera& camera, const Eigen::Vector3f& p_W_m,
                                   float width_px, float height_px);

// The camera of the same direction and field of view from the nearest place that has all points
// within the middle `fill` of the picture (0..1, both axes); of its height `covered_below` (0..0.4)
// does not count, as something covers it at the bottom.
OrbitCamera frame_points(const OrbitCamera& camera, std::span<const Eigen::Vector3f> points_W_m,
                         float aspect, float fill, float covered_below = 0.0f);

// The yaw from which a group is seen best: across the line on which they stand, on the side that
// most of them face; a single dancer from the front, a little to the side.
float best_yaw_rad(std::span<const Eigen::Vector3f> hips_W_m,
                   std::span<const Eigen::Vector3f> facing_W);

// A box of parallel light that holds a ball round `centre`: clip from W, for the shadow map. The
// centre snaps to whole texels, so that shadows do not crawl when the box moves.
Eigen::Matrix4f light_clip_from_world(const Eigen::Vector3f& to_light_W,
                                      const Eigen::Vector3f& centre_W_m, float radius_m,
                                      int map_size_px);

}  // namespace dance
