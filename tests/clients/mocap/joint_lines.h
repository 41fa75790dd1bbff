// Joints that a client wrote down, one line of JSON for each dancer and frame, and where they
// should be.
//
// Units/frames: metres in W.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a line that is no JSON fails the test.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dance {

using JointPlaces = std::map<std::string, Eigen::Vector3d>;

struct JointLine {
  std::string name;
  double total_height_m = 0.0;
  JointPlaces joints;
};

inline std::string client_seconds() {
  const char* given = std::getenv("DANCE_CLIENT_SECONDS");
  return given ? given : "15";
}

inline std::vector<JointLine> read_joint_lines(const std::string& path) {
  std::vector<JointLine> lines;
  std::ifstream file(path);
  for (std::string text; std::getline(file, text);) {
    const auto json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_discarded()) {
      ADD_FAILURE() << text.substr(0, 100);
      break;
    }
    JointLine line;
    line.name = json.value("name", "");
    line.total_height_m = json.value("totalHeight", 0.0);
    for (const auto& [joint, p] : json["joints"].items())
      line.joints[joint] = Eigen::Vector3d(p[0], p[1], p[2]);
    lines.push_back(std::move(line));
  }
  return lines;
}

inline double worst_apart_m(const JointPlaces& a, const JointPlaces& b) {
  double worst = 0.0;
  for (const auto& [joint, place] : a) {
    const auto other = b.find(joint);
    if (other != b.end()) worst = std::max(worst, (place - other->second).norm());
  }
  return worst;
}

// The frame in which the root is nearest.
inline const JointPlaces* nearest(const std::vector<JointPlaces>& frames, const JointPlaces& to,
                                  const std::string& root) {
  const JointPlaces* best = nullptr;
  double least = 1e9;
  for (const JointPlaces& frame : frames) {
    const double apart = (frame.at(root) - to.at(root)).norm();
    if (apart < least) {
      least = apart;
      best = &frame;
    }
  }
  return best;
}

}  // namespace dance
