// A standing dancer's landmarks for tests: seen from the front, 150 pixels tall, in a picture of
// 160 × 200.
//
// Threads: none.
// Failure: none.
#pragma once

#include "producers/camera/body_landmarks.h"

namespace dance {

inline BodyLandmarks standing_body() {
  BodyLandmarks body;
  body.found = true;
  body.presence = 1.0f;
  body.region = {80.0f, 100.0f, 180.0f, 0.0f};
  body.visibility.fill(1.0f);
  body.image_px.fill({80.0f, 30.0f, 0.0f});  // the face
  body.world_m.fill(Eigen::Vector3f::Zero());
  const auto put = [&](Landmark left, Landmark right, float half_width, float y) {
    // A dancer who faces the camera has her left side at the right of the picture.
    body.image_px[index_of(left)] = {80.0f + half_width, y, 0.0f};
    body.image_px[index_of(right)] = {80.0f - half_width, y, 0.0f};
  };
  using enum Landmark;
  put(kLeftShoulder, kRightShoulder, 20.0f, 55.0f);
  put(kLeftElbow, kRightElbow, 35.0f, 75.0f);
  put(kLeftWrist, kRightWrist, 40.0f, 98.0f);
  put(kLeftPinky, kRightPinky, 41.0f, 104.0f);
  put(kLeftIndex, kRightIndex, 40.0f, 106.0f);
  put(kLeftThumb, kRightThumb, 38.0f, 104.0f);
  put(kLeftHip, kRightHip, 12.0f, 100.0f);
  put(kLeftKnee, kRightKnee, 12.0f, 137.0f);
  put(kLeftAnkle, kRightAnkle, 12.0f, 172.0f);
  put(kLeftHeel, kRightHeel, 11.0f, 176.0f);
  put(kLeftFootIndex, kRightFootIndex, 15.0f, 180.0f);
  return body;
}

}  // namespace dance
