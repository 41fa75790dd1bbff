#include "producers/camera/estimator/model_files.h"

#include <cstdlib>
#include <filesystem>

#include "core/program/program.h"
#include "producers/camera/estimator/tflite_file.h"

namespace dance {
namespace {

constexpr const char* kDetector = "/pose_detection.tflite";

std::string variable(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): at start
  return value ? value : "";
}

std::string users_folder() {
  if (const std::string data = variable("XDG_DATA_HOME"); !data.empty())
    return data + "/dancegraph/pose";
  return variable("HOME") + "/.local/share/dancegraph/pose";
}

}  // namespace

std::string_view name_of(PoseNetworkModel model) {
  switch (model) {
    case PoseNetworkModel::kLite:
      return "lite";
    case PoseNetworkModel::kFull:
      return "full";
    case PoseNetworkModel::kHeavy:
      return "heavy";
  }
  return "";
}

std::string pose_models_folder(const std::string& wished) {
  if (!wished.empty()) return wished;
  if (const std::string folder = variable("DANCE_POSE_MODELS"); !folder.empty()) return folder;
  for (const std::string& folder :
       {data_folder() + "/pose", users_folder(), std::string("/var/lib/dancegraph/pose")})
    if (std::filesystem::exists(folder + kDetector)) return folder;
  return users_folder();
}

Result<PoseGraph> read_detector(const std::string& folder) {
  return read_tflite_file(folder + kDetector);
}

Result<PoseGraph> read_landmark_model(const std::string& folder, PoseNetworkModel model) {
  return read_tflite_file(folder + "/pose_landmark_" + std::string(name_of(model)) + ".tflite");
}

}  // namespace dance
