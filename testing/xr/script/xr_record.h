// XrRecord: what an application did with the OpenXR test runtime, one event a line:
//
//   session STATE t                          as the runtime changed it
//   frame N display_time layers K            each xrEndFrame
//   view left|right x y z qx qy qz qw left right up down space
//   quad x y z qx qy qz qw width height space
//   haptic left|right amplitude duration_ns frequency t
//   haptic_stop left|right
//   located POINT                            the first time that an application locates it; also
//                                            POINT of a tracker's role, view, local, stage
//   misuse FUNCTION: reason
//   script REASON                            the script cannot be read
//
// Units/frames: metres, radians, t in seconds of the script; spaces are view, local, stage, action.
// Ownership:    owns the file.
// Threads:      any, as lines are written whole; flushed after each.
// Failure:      a file that cannot be written is said once on stderr.
#pragma once

#include <cstdio>
#include <mutex>
#include <string>

namespace dance::test_xr {

class XrRecord {
 public:
  XrRecord() = default;
  ~XrRecord() { close(); }
  XrRecord(const XrRecord&) = delete;
  XrRecord& operator=(const XrRecord&) = delete;

  // Goes on at the end of the file; an empty path records nothing.
  void open(const std::string& path);
  void close();
  void line(const std::string& text);

 private:
  std::mutex mutex_;
  std::FILE* file_ = nullptr;
};

}  // namespace dance::test_xr
