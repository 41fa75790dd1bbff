#include "producers/camera/check/camera_cause.h"

#include <linux/videodev2.h>

#include <cerrno>
#include <filesystem>

#include "producers/camera/v4l2/camera_list.h"
#include "producers/camera/v4l2/v4l2_device.h"

namespace dance {
namespace {

CameraCause cause_of_number(int number) {
  switch (number) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return CameraCause::kAbsent;
    case EACCES:
    case EPERM:
      return CameraCause::kNoPermission;
    case EBUSY:
      return CameraCause::kInUse;
    default:
      return CameraCause::kOther;
  }
}

// Drivers let several programs open a camera, and one of them use it.
CameraCause cause_of_open(const V4l2Device& device) {
  v4l2_requestbuffers request{};
  request.count = 2;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  const int number = device.call(VIDIOC_REQBUFS, &request);
  if (number != 0) return cause_of_number(number);
  return holders_of(device.path()).empty() ? CameraCause::kOther : CameraCause::kInUse;
}

}  // namespace

CameraCause cause_of_failure(const std::string& called) {
  std::error_code ignored;
  const bool is_file = !called.starts_with("/dev/") && std::filesystem::exists(called, ignored);
  if (is_file) return CameraCause::kOther;
  const auto cameras = list_cameras();
  const auto path = camera_path(called, cameras);
  if (!path && cameras.empty()) return CameraCause::kAbsent;
  const bool is_any = called.empty() || called == "auto";
  if (!path && !is_any) return CameraCause::kAbsent;
  const auto device = V4l2Device::open(path ? *path : cameras.front().path);
  return device ? cause_of_open(*device) : cause_of_number(device.error().number);
}

}  // namespace dance
