// The networks and the material of the tests, where this machine has them.
//
// Ownership: values.
// Threads:   none inside.
// Failure:   a test whose material is missing is skipped with a line that says how to get it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "producers/camera/estimator/model_files.h"

namespace dance {

inline bool has_pose_models() {
  const std::string folder = pose_models_folder("");
  return std::filesystem::exists(folder + "/pose_detection.tflite") &&
         std::filesystem::exists(folder + "/pose_landmark_full.tflite");
}

inline std::string taiji_video() { return DANCE_SOURCE_DIR "/../shared/data/video/taiji.mp4"; }
inline std::string opencv_sample(const std::string& name) {
  return "/usr/share/doc/opencv-doc/examples/data/" + name;
}

}  // namespace dance

#define SKIP_WITHOUT_POSE_MODELS() \
  if (!has_pose_models())          \
  GTEST_SKIP() << "the pose networks are missing: ./dance setup fetches them"
#define SKIP_WITHOUT_VIDEO() \
  if (!std::filesystem::exists(taiji_video())) GTEST_SKIP() << taiji_video() << " is missing"
