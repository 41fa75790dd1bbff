// The cameras of this machine, for a choice in a window, from `dance capture --list --json`: a
// driver that hangs holds up no window.
//
// Units/frames: pixels, hertz.
// Ownership:    owns the program until it has answered, and the pipe.
// Threads:      none inside; read() never waits.
// Failure:      a camera that cannot be used is listed with its cause; a program that is not there
//               or gives no list is an empty list, and has_failed().
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/program/child_pipe.h"
#include "core/program/child_process.h"

namespace dance {

struct ListedCamera {
  std::string device;   // "/dev/video0", as `dance capture` and a session file take it
  std::string name;     // "HD Webcam"; the device where it cannot be opened
  std::string mode;     // what is taken unless asked otherwise: "1280x720 YUYV at 30 Hz"
  std::string trouble;  // not empty: why it cannot be used
};

// Of the program's output. Pure; nothing where it is no such list.
std::optional<std::vector<ListedCamera>> parse_camera_list(std::string_view json);

class CameraList {
 public:
  // "" = dance-capture beside this program.
  static Result<std::unique_ptr<CameraList>> start(const std::string& program = "");
  CameraList(const CameraList&) = delete;
  CameraList& operator=(const CameraList&) = delete;

  // Readable when there is something to read(); -1 once the answer is there.
  int fd() const { return pipe_.fd(); }
  void read();
  bool is_done() const { return !pipe_.is_open(); }
  bool has_failed() const { return has_failed_; }
  std::span<const ListedCamera> cameras() const { return cameras_; }

 private:
  CameraList() = default;
  void end();

  bool has_failed_ = false;
  std::string said_;
  std::optional<ChildProcess> program_;
  ChildPipe pipe_;  // ends before the program, which then has nobody to write to
  std::vector<ListedCamera> cameras_;
};

}  // namespace dance
