#include "producers/capture_recording.h"

#include <fmt/core.h>

#include <chrono>
#include <filesystem>

namespace dance {
namespace {

std::int64_t wall_clock_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

Result<std::unique_ptr<CaptureRecording>> CaptureRecording::create(const std::string& folder,
                                                                   double hz, CaptureSink& behind) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail("--record '" + folder + "': " + error.message());
  for (const char* name : {"/video.mkv", "/poses.lcm"})
    if (std::filesystem::exists(folder + name))
      return fail("--record '" + folder + "' has a recording already; name another folder");
  DANCE_TRY(LogWriter log, LogWriter::create(folder + "/poses.lcm"));
  std::unique_ptr<CaptureRecording> made(new CaptureRecording(std::move(log), behind));
  DANCE_TRY(made->video_, VideoWriter::create(folder + "/video.mkv", hz));
  return made;
}

template <class Message>
void CaptureRecording::append(Signal signal, const GuestId& guest, const Message& message) {
  if (log_failure_) return;
  const std::size_t size = encode(message, buffer_);
  const Channel channel = Channel::of(signal, Where::kCapture, guest);
  auto done = log_.append(wall_clock_us(), channel.view(), {buffer_.data(), size});
  if (!done) log_failure_ = done.error();
}

// To the bus first: the log may wait for a disk.
void CaptureRecording::capture(const GuestId& guest, Pose& pose, MonoTime now) {
  behind_.capture(guest, pose, now);
  append(Signal::kPose, guest, pose);
}
void CaptureRecording::capture(const GuestId& guest, const Hands& hands) {
  behind_.capture(guest, hands);
  append(Signal::kHands, guest, hands);
}
void CaptureRecording::capture(const GuestId& guest, const TimedSkeleton& skeleton) {
  behind_.capture(guest, skeleton);
  append(Signal::kSkeleton, guest, skeleton);
}

void CaptureRecording::finish() {
  video_->finish();
  if (!log_failure_)
    if (auto done = log_.flush(); !done) log_failure_ = done.error();
}

std::string CaptureRecording::summary() const {
  return fmt::format("{} pictures in video.mkv ({} left out), {} events in poses.lcm",
                     video_->written(), video_->left_out(), log_.events());
}

std::string CaptureRecording::trouble() const {
  if (log_failure_) return log_failure_->what;
  return video_->trouble();
}

}  // namespace dance
