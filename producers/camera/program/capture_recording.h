// CaptureRecording: what `dance capture --record FOLDER` keeps: video.mkv with the times of its
// pictures, and poses.lcm, an LCM log of the poses and the proportions that were published. `dance
// replay FOLDER/poses.lcm` dances it again.
//
// Units/frames: as pose_t and skeleton_t; the log's event times in microseconds since 1970, as
//               core/net/clock/recording_clock.h gives them.
// Ownership:    owns its files; refers to the sink behind it, which must outlive it.
// Threads:      as VideoWriter, and one that writes the log: the capture's never waits for a disk.
//               What a slow disk cannot take is dropped, the oldest first, and summary() counts it
//               after finish().
// Failure:      create() refuses a folder that has a recording already and names what cannot be
//               written; a log that fails later ends, and trouble() gives the reason. Poses are
//               published either way.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "core/base/spsc_ring.h"
#include "core/bus/channel.h"
#include "core/bus/encode.h"
#include "core/net/clock/recording_clock.h"
#include "formats/log/log_file.h"
#include "producers/camera/record/video_writer.h"
#include "producers/capture_sink.h"

namespace dance {

// A message on its way to the log.
struct RecordedMessage {
  std::int64_t time_us = 0;
  Channel channel;
  std::uint32_t size = 0;
  MessageBuffer data{};
};

class CaptureRecording : public CaptureSink {
 public:
  static Result<std::unique_ptr<CaptureRecording>> create(const std::string& folder, double hz,
                                                          CaptureSink& behind);
  // Takes the files away again when nothing was written.
  ~CaptureRecording() override;

  void add(const Frame& frame) { video_->add(frame); }
  // Writes what is waiting and closes the video.
  void finish();
  std::string summary() const;
  std::string trouble() const;

  void capture(const GuestId& guest, Pose& pose, MonoTime now) override;
  void capture(const GuestId& guest, const Hands& hands) override;
  void capture(const GuestId& guest, const TimedSkeleton& skeleton) override;
  void capture_face(const GuestId& guest, const Face& face) override {
    behind_.capture_face(guest, face);
  }

 private:
  static constexpr std::size_t kWaiting = 1024;  // eight seconds of poses and hands at 60 Hz

  CaptureRecording(std::string folder, LogWriter log, CaptureSink& behind)
      : folder_(std::move(folder)), log_(std::move(log)), behind_(behind) {}
  template <class Message>
  void append(Signal signal, const GuestId& guest, const Message& message);
  void run();
  void end_with(const Error& why);

  std::string folder_;
  std::unique_ptr<VideoWriter> video_;
  LogWriter log_;  // the thread's, while it runs
  CaptureSink& behind_;
  RecordingClock clock_;
  RecordedMessage event_;  // the capture's side
  SpscRing<RecordedMessage, kWaiting> events_;
  std::uint64_t given_ = 0;  // the capture's side
  std::atomic<std::uint64_t> written_{0};
  std::atomic<bool> stop_{false};
  std::atomic<bool> log_failed_{false};
  std::string log_trouble_;  // written before log_failed_, read after
  std::thread thread_;
};

}  // namespace dance
