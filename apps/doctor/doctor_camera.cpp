#include "apps/doctor/doctor_camera.h"

#ifdef DANCE_HAVE_CAMERA
#include <algorithm>

#include "producers/camera/estimator/model_files.h"
#include "producers/camera/estimator/pose_engine.h"
#include "producers/camera/v4l2/camera_list.h"
#endif

namespace dance {
#ifdef DANCE_HAVE_CAMERA
Finding check_camera() {
  const auto cameras = list_cameras();
  const auto fine = std::find_if(cameras.begin(), cameras.end(),
                                 [](const CameraEntry& c) { return c.trouble.empty(); });
  if (fine != cameras.end()) return {"camera", Finding::Grade::kOk, cameras_in_a_line(cameras), ""};
  if (!cameras.empty())
    return {"camera", Finding::Grade::kNote, cameras.front().trouble,
            "dance capture --list   (tells more)"};
  return {"camera", Finding::Grade::kNote, "none; videos, replay and salsa dance without one", ""};
}

Finding check_pose_network() {
  const std::string folder = pose_models_folder("");
  const auto detector = read_detector(folder);
  const auto body = read_landmark_model(folder, PoseNetworkModel::kFull);
  if (detector && body)
    return {"pose network", Finding::Grade::kOk,
            folder + ", on " + std::string(name_of(chosen_engine(EngineKind::kFastest))), ""};
  return {"pose network", Finding::Grade::kNote,
          detector ? body.error().what : detector.error().what,
          "dance fetch-models   (only dance capture needs it)"};
}
#else
Finding check_camera() {
  return {"camera", Finding::Grade::kNote,
          "this build has none: OpenCV was not there when it was made",
          "./dance setup   (installs and builds what it needs)"};
}
Finding check_pose_network() {
  return {"pose network", Finding::Grade::kNote, "not in this build", ""};
}
#endif

}  // namespace dance
