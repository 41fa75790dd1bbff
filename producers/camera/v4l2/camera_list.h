// The cameras of this machine, for people and for finding one again.
//
// Units/frames: pixels, hertz.
// Ownership:    plain values.
// Threads:      none inside; looking opens each device for a moment.
// Failure:      a device that is there and cannot be opened is listed with the reason and the cure;
//               no camera is an empty list, and the table then says what to do.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "producers/camera/v4l2/video_mode.h"

namespace dance {

struct CameraEntry {
  std::string path;      // "/dev/video0"
  std::string name;      // "HD Webcam"
  std::string bus_info;  // where it is plugged in
  std::vector<VideoMode> modes;
  std::string trouble;  // not empty: why it cannot be used; nothing else but the path is then known
};

// By number of the device.
std::vector<CameraEntry> list_cameras();

// What `dance capture --list` prints, with a line break at the end.
std::string camera_table(std::span<const CameraEntry> cameras);

// The same for programs, as JSON: an array of {"device", "name", "socket", "mode", "trouble"};
// "mode" is what is taken unless asked otherwise, and "trouble" is "" where there is none.
std::string camera_json(std::span<const CameraEntry> cameras);

// "/dev/video0 (HD Webcam), /dev/video2 (…)", or what to do where there is none.
std::string cameras_in_a_line(std::span<const CameraEntry> cameras);

// The device path of a camera that is called by path, number or (part of its) name, whether or not
// it is there: "" and "auto" mean the first, before others one that sees colours.
Result<std::string> camera_path(const std::string& called, std::span<const CameraEntry> cameras);

// Of what is there now the camera that `lost` was: in the same socket, or of the same name in a
// socket where no other of its name was when it was opened. Nullptr where it is not back.
const CameraEntry* found_again(const CameraEntry& lost,
                               std::span<const std::string> taken_bus_infos,
                               std::span<const CameraEntry> cameras);

}  // namespace dance
