// What a camera sees of a dancer who stands in a lit room, for tests.
//
// Units/frames: as formats/camera_view/camera_view.h.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include <utility>
#include <vector>

#include "formats/camera_view/camera_view.h"

namespace dance {

// Upright, facing the camera: `height` from crown to soles, the crown at `top`, in shares of the
// picture's height.
inline SeenBody2d standing_in(float height, float top, float centre_x = 0.5f) {
  SeenBody2d body;
  body.is_found = true;
  const auto put = [&](std::size_t left, std::size_t right, float half_width, float down) {
    const float y = top + down * height;
    body.points[left] = {centre_x + half_width * height, y, 1.0f};
    body.points[right] = {centre_x - half_width * height, y, 1.0f};
  };
  for (std::size_t i = 0; i <= 10; ++i) body.points[i] = {centre_x, top + 0.075f * height, 1.0f};
  put(7, 8, 0.03f, 0.075f);
  put(11, 12, 0.07f, 0.19f);
  put(13, 14, 0.09f, 0.36f);
  for (const auto& [left, right] :
       {std::pair{15, 16}, std::pair{17, 18}, std::pair{19, 20}, std::pair{21, 22}})
    put(left, right, 0.10f, 0.5f);
  put(23, 24, 0.05f, 0.5f);
  put(25, 26, 0.05f, 0.74f);
  put(27, 28, 0.05f, 0.95f);
  put(29, 30, 0.05f, 0.98f);
  put(31, 32, 0.06f, 1.0f);
  return body;
}

inline CameraFacts good_facts() {
  CameraFacts facts;
  facts.time = MonoTime::from_us(1'000'000);
  facts.pictures_hz = 30.0f;
  facts.light = {0.45f, 0.6f, 0.01f, 0.45f, 0.45f};
  facts.body = standing_in(0.75f, 0.12f);
  return facts;
}

inline CameraStatus running_status() {
  CameraStatus status;
  status.state = CameraState::kRunning;
  status.has_network = true;
  status.width_px = 1280;
  status.height_px = 720;
  (void)status.name.assign("HD Webcam (/dev/video0)");
  return status;
}

// Of these colours, each byte another.
inline std::vector<std::uint8_t> drawn_rgb(int width, int height, int seed) {
  std::vector<std::uint8_t> rgb(3UL * static_cast<std::size_t>(width * height));
  for (std::size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = static_cast<std::uint8_t>(i * 31 + static_cast<std::size_t>(seed));
  return rgb;
}

}  // namespace dance
