#include "producers/camera/estimator/model_files.h"

#include <cstdlib>

#include "producers/camera/estimator/tflite_file.h"

namespace dance {

std::string_view name_of(PoseModel model) {
  switch (model) {
    case PoseModel::kLite:
      return "lite";
    case PoseModel::kFull:
      return "full";
    case PoseModel::kHeavy:
      return "heavy";
  }
  return "";
}

std::string pose_models_folder(const std::string& wished) {
  if (!wished.empty()) return wished;
  const char* folder = std::getenv("DANCE_POSE_MODELS");  // NOLINT(concurrency-mt-unsafe): at start
  return folder && *folder ? folder : DANCE_POSE_MODELS_FOLDER;
}

Result<PoseGraph> read_detector(const std::string& folder) {
  return read_tflite_file(folder + "/pose_detection.tflite");
}

Result<PoseGraph> read_landmark_model(const std::string& folder, PoseModel model) {
  return read_tflite_file(folder + "/pose_landmark_" + std::string(name_of(model)) + ".tflite");
}

}  // namespace dance
