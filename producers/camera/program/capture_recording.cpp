#include "producers/camera/program/capture_recording.h"

#include <fmt/core.h>

#include <filesystem>
#include <optional>

namespace dance {
Result<std::unique_ptr<CaptureRecording>> CaptureRecording::create(const std::string& folder,
                                                                   double hz, CaptureSink& behind) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail("--record '" + folder + "': " + error.message());
  for (const char* name : {"/video.mkv", "/video.mkv.tsv", "/poses.lcm"})
    if (std::filesystem::exists(folder + name))
      return fail("--record '" + folder + "' has a recording already; name another folder");
  DANCE_TRY(LogWriter log, LogWriter::create(folder + "/poses.lcm"));
  std::unique_ptr<CaptureRecording> made(new CaptureRecording(folder, std::move(log), behind));
  DANCE_TRY(made->video_, VideoWriter::create(folder + "/video.mkv", hz));
  made->thread_ = std::thread([m = made.get()] { m->run(); });
  return made;
}

// A recording that failed to start removes its files, so that the same folder can be named again.
CaptureRecording::~CaptureRecording() {
  finish();
  if (written_ > 0 || (video_ && video_->written() > 0)) return;
  std::error_code ignored;
  std::filesystem::remove(folder_ + "/poses.lcm", ignored);
  if (!video_) return;
  std::filesystem::remove(folder_ + "/video.mkv", ignored);
  std::filesystem::remove(folder_ + "/video.mkv.tsv", ignored);
}

template <class Message>
void CaptureRecording::append(Signal signal, const GuestId& guest, const Message& message) {
  const std::size_t size = encode(message, event_.data);
  event_.size = static_cast<std::uint32_t>(size);
  event_.time_us = clock_.wall_us(mono_now());
  event_.channel = Channel::of(signal, Where::kCapture, guest);
  events_.push(event_);
  ++given_;
}

void CaptureRecording::run() {
  for (;;) {
    const bool is_last_look = stop_;
    const std::optional<RecordedMessage> event = events_.pop();
    if (!event) {
      if (is_last_look) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      continue;
    }
    auto done =
        log_.append(event->time_us, event->channel.view(), {event->data.data(), event->size});
    if (!done) return end_with(done.error());
    ++written_;
  }
}

void CaptureRecording::end_with(const Error& why) {
  log_trouble_ = why.what;
  log_failed_ = true;
}

// To the bus first.
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
  if (video_) video_->finish();
  stop_ = true;
  if (!thread_.joinable()) return;
  thread_.join();
  if (log_failed_) return;
  if (auto done = log_.flush(); !done) end_with(done.error());
}

std::string CaptureRecording::summary() const {
  const std::uint64_t written = written_;
  return fmt::format("{} pictures in video.mkv ({} left out), {} events in poses.lcm ({} left out)",
                     video_->written(), video_->left_out(), written, given_ - written);
}

std::string CaptureRecording::trouble() const {
  return log_failed_ ? log_trouble_ : video_->trouble();
}

}  // namespace dance
