// CameraCheck: the live preview of a camera and what the dancer is to mend, from `dance capture
// --check`, which runs beside this program: a driver that hangs holds up no window.
//
// Units/frames: as formats/camera_view/camera_view.h.
// Ownership:    owns the program, which ends with it, and the pipe. Pictures and texts are good
//               until the next read().
// Threads:      none inside; read() never waits.
// Failure:      start() fails where no pipe can be made. Whatever else is wrong is advice(): a
//               build without cameras, one that is taken, not there or unplugged, a driver that
//               hangs, a program that has ended.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/program/child_pipe.h"
#include "core/program/child_process.h"
#include "formats/camera_view/camera_view_reader.h"
#include "producers/camera/advice/camera_advice.h"

namespace dance {

class CameraCheck {
 public:
  struct Options {
    std::string device;   // as `dance capture` takes it, a video too; "" = the first camera
    std::string program;  // "" = dance-capture beside this program
    std::string model = "lite";
  };

  static Result<std::unique_ptr<CameraCheck>> start(const Options& options);
  static Result<std::unique_ptr<CameraCheck>> start(const std::string& device) {
    return start(Options{device, "", "lite"});
  }
  CameraCheck(const CameraCheck&) = delete;
  CameraCheck& operator=(const CameraCheck&) = delete;

  // Readable when there is something to read(); -1 once nothing more comes.
  int fd() const { return pipe_.fd(); }
  void read(MonoTime now);

  // The newest picture; false where none came since the last call.
  bool take(PreviewPicture& out);
  // What is seen in it, with the points of the body; and the camera's state, name and size.
  const CameraFacts& facts() const { return reader_.facts(); }
  const CameraStatus& status() const { return reader_.status(); }

  // What to mend, what matters most first, three at most; or that all is well. Never empty.
  std::span<const Text> advice() const;
  bool is_good() const { return !instead_ && advice_.is_good(); }

 private:
  CameraCheck() = default;
  void end(Text why);
  void note_end();
  void read_all(MonoTime now);
  void look_for_stall(MonoTime now);

  std::optional<ChildProcess> program_;
  ChildPipe pipe_;  // ends before the program, which then has nobody to write to
  CameraViewReader reader_;
  CameraAdvice advice_;
  std::optional<Text> instead_;  // of the advice: it has ended, or hangs
  MonoTime last_heard_;
  bool has_picture_ = false;
};

}  // namespace dance
