#include "producers/camera/files/played_reel.h"

#include <poll.h>

#include <algorithm>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

// A reader that cannot decode in real time would skip for ever: further behind than this, the film
// waits.
constexpr Duration kFarthestBehind = Duration::s(1);

}  // namespace

PlayedReel::PlayedReel(std::unique_ptr<PictureReel> reel, const PlayOptions& options)
    : reel_(std::move(reel)), options_(options) {
  const double hz = options.hz > 0.0 && !options.is_real_time ? options.hz : reel_->hz();
  period_ = Duration::period_of_hz(hz);
  format_ = {reel_->width_px(), reel_->height_px(), hz, reel_->encoding()};
}

bool PlayedReel::step() {
  fetched_ = mono_now();
  if (!reel_->step()) {
    if (reel_->is_cut_off()) ++counters_.damaged;
    round_ = last_time_ + period_;
    is_over_ = !options_.loops || !reel_->rewind() || !reel_->step();
    if (is_over_) return false;
  }
  last_time_ = round_ + reel_->time();
  ++stepped_;
  stands_ = true;
  return true;
}

bool PlayedReel::wait_until_due(Duration timeout) {
  const MonoTime due = start_ + last_time_;
  const MonoTime now = mono_now();
  if (due <= now) return true;
  const std::int64_t ms = (std::min(due - now, timeout).count_ns() + 999'999) / 1'000'000;
  if (ms > 0) ::poll(nullptr, 0, static_cast<int>(std::min<std::int64_t>(ms, 1 << 30)));
  fetched_ = mono_now();
  return due <= fetched_;
}

// False: that was the end.
bool PlayedReel::skip_what_is_late() {
  const MonoTime now = mono_now();
  while (start_ + last_time_ + period_ <= now) {
    ++counters_.outrun;
    stands_ = false;
    if (!step()) return false;
  }
  // Skipping takes time too.
  const Duration behind = mono_now() - (start_ + last_time_);
  if (behind > kFarthestBehind) start_ += behind;
  return true;
}

FrameState PlayedReel::next(Duration timeout, Frame& out) {
  out.image.release();
  if (stands_) fetched_ = mono_now();  // time since the last call is not decoding time
  if (is_over_ || (!stands_ && !step())) return FrameState::kOver;
  if (!start_.is_set()) start_ = mono_now();
  if (options_.is_real_time) {
    if (!wait_until_due(timeout)) return FrameState::kNone;
    if (!skip_what_is_late()) return FrameState::kOver;
  }
  stands_ = false;
  cv::Mat& picture = pictures_.unheld();
  if (!reel_->read(picture)) {
    ++counters_.damaged;
    return FrameState::kNone;
  }
  out.image = picture;
  out.sequence = stepped_;
  out.capture_time = options_.is_real_time
                         ? start_ + last_time_
                         : start_ + period_ * static_cast<std::int64_t>(stepped_ - 1);
  // A film that waited for its reader is of now.
  out.fetched = options_.is_real_time ? std::max(fetched_, out.capture_time) : fetched_;
  ++counters_.taken;
  return FrameState::kFrame;
}

}  // namespace dance
