// CaptureRecording: what `dance capture --record FOLDER` keeps: video.mkv with the times of its pictures, and poses.lcm, an LCM log of
// the poses and the proportions that were published. `dance replay FOLDER/poses.lcm` dances it again.
//
// Units/frames: as pose_t and skeleton_t; the log's event times in microseconds of the wall clock, as LCM's.
// Ownership:    owns its files; refers to the sink behind it, which must outlive it.
// Threads:      as VideoWriter; the rest in the capture's thread.
// Failure:      create() refuses a folder that has a recording already and names what cannot be written; a log that fails later
//               ends, and trouble() tells it. The poses go on either way.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/bus/encode.h"
#include "core/bus/log_file.h"
#include "producers/camera/record/video_writer.h"
#include "producers/capture_sink.h"

namespace dance {

class CaptureRecording : public CaptureSink {
 public:
  static Result<std::unique_ptr<CaptureRecording>> create(const std::string& folder, double hz,
                                                          CaptureSink& behind);

  void add(const Frame& frame) { video_->add(frame); }
  void finish();
  std::string summary() const;
  std::string trouble() const;

  void capture(const GuestId& guest, Pose& pose, MonoTime now) override;
  void capture(const GuestId& guest, const Hands& hands) override;
  void capture(const GuestId& guest, const TimedSkeleton& skeleton) override;

 private:
  CaptureRecording(LogWriter log, CaptureSink& behind) : log_(std::move(log)), behind_(behind) {}
  template <class Message>
  void append(Signal signal, const GuestId& guest, const Message& message);

  std::unique_ptr<VideoWriter> video_;
  LogWriter log_;
  CaptureSink& behind_;
  MessageBuffer buffer_{};
  std::optional<Error> log_failure_;
};

}  // namespace dance
