// What the original makes of the same pictures: tests/producers/camera/estimator/golden.
//
// Units/frames: as producers/camera/body_landmarks.h says.
// Ownership:    values.
// Threads:      none inside.
// Failure:      a test fails that gets an empty map: the file is not there.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "producers/camera/body_landmarks.h"

namespace dance {

// By name: "frame 25", "sample messi5.jpg".
inline std::map<std::string, BodyLandmarks> golden_bodies(const std::string& name) {
  std::ifstream file(DANCE_SOURCE_DIR "/tests/producers/camera/estimator/golden/" + name);
  std::map<std::string, BodyLandmarks> bodies;
  std::string line;
  BodyLandmarks* body = nullptr;
  std::size_t point = 0;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == 'f' || line[0] == 's') {
      body = &bodies[line];
      point = 0;
      continue;
    }
    if (!body || point >= kLandmarkCount) return {};
    Eigen::Vector3f& i = body->image_px[point];
    Eigen::Vector3f& w = body->world_m[point];
    std::istringstream(line) >> i.x() >> i.y() >> i.z() >> body->visibility[point] >> w.x() >>
        w.y() >> w.z();
    ++point;
  }
  return bodies;
}

// Every point within `percent` of the region's side and `metres`.
inline void expect_like(const BodyLandmarks& got, const BodyLandmarks& due, double percent,
                        double metres, const std::string& name) {
  ASSERT_TRUE(got.found) << name;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const double off = (got.image_px[i] - due.image_px[i]).head<2>().norm();
    EXPECT_LE(100.0 * off / got.region.side_px, percent) << name << " point " << i;
    EXPECT_LE(100.0 * std::abs(got.image_px[i].z() - due.image_px[i].z()) / got.region.side_px,
              percent)
        << name << " point " << i;
    EXPECT_LE((got.world_m[i] - due.world_m[i]).norm(), metres) << name << " point " << i;
    EXPECT_NEAR(got.visibility[i], due.visibility[i], 0.02) << name << " point " << i;
  }
}

}  // namespace dance
