#include "producers/camera/v4l2/v4l2_camera.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

// An older stamp is a clock that was set, not a picture that waited.
constexpr Duration kOldest = Duration::s(10);

void wait_until(MonoTime when) {
  const std::int64_t ms = ((when - mono_now()).count_ns() + 999'999) / 1'000'000;
  if (ms > 0) ::poll(nullptr, 0, static_cast<int>(std::min<std::int64_t>(ms, 1 << 30)));
}

}  // namespace

Result<std::unique_ptr<V4l2Camera>> V4l2Camera::open(const std::string& called,
                                                     const CameraWish& wish,
                                                     const CameraTimeouts& timeout) {
  const std::vector<CameraEntry> cameras = list_cameras();
  DANCE_TRY(const std::string path, camera_path(called, cameras));
  std::unique_ptr<V4l2Camera> camera(new V4l2Camera(wish, timeout));
  if (auto started = camera->start(path); !started) return tl::make_unexpected(started.error());
  for (const CameraEntry& other : cameras) {
    if (other.name == camera->identity_.name && other.bus_info != camera->identity_.bus_info) {
      camera->others_.push_back(other.bus_info);
    }
  }
  return camera;
}

Result<void> V4l2Camera::start(const std::string& path) {
  auto device = V4l2Device::open(path);
  if (!device) {
    const DeviceTrouble& trouble = device.error();
    const bool is_missing =
        trouble.number == ENOENT || trouble.number == ENODEV || trouble.number == ENXIO;
    return fail(is_missing ? trouble.what + "; " + cameras_in_a_line(list_cameras())
                           : trouble.what);
  }
  DANCE_TRY(V4l2Stream stream, V4l2Stream::start(std::move(*device), wish_));
  auto convert = PictureConverter::make(stream.layout(), wish_.max_height_px);
  if (!convert) return fail(stream.device().name() + ": " + convert.error().what);
  identity_ = {stream.device().path(), stream.device().card(), stream.device().bus_info(), {}, ""};
  name_ = stream.device().name();
  stream_.emplace(std::move(stream));
  convert_.emplace(std::move(*convert));
  format_ = {convert_->width_px(), convert_->height_px(), stream_->mode().hz(),
             text_of_fourcc(stream_->mode().fourcc)};
  driver_sequence_.reset();
  has_driver_stamps_ = true;
  is_refreshing_ = false;
  alive_at_ = mono_now();
  return {};
}

std::string V4l2Camera::negotiated() const {
  if (!stream_) return name_ + ": unplugged";
  std::string text = name_ + ": " + text_of(stream_->mode());
  if (format_.height_px != stream_->mode().height_px) {
    text +=
        ", read at " + std::to_string(format_.width_px) + "x" + std::to_string(format_.height_px);
  }
  text += ", asked for " + text_of(wish_);
  if (stream_->holds_the_rate()) text += "; the rate stays in the dark too";
  if (!has_driver_stamps_)
    text += "; the driver gives no usable time, pictures are stamped when fetched";
  return text;
}

void V4l2Camera::lose() {
  convert_.reset();
  stream_.reset();
  ++counters_.unplugged;
  look_at_ = mono_now() + timeouts_.look_every;
}

FrameState V4l2Camera::look_again(MonoTime deadline) {
  if (look_at_ > mono_now()) {
    wait_until(std::min(look_at_, deadline));
    if (look_at_ > mono_now()) return FrameState::kGone;
  }
  look_at_ = mono_now() + timeouts_.look_every;
  const std::vector<CameraEntry> cameras = list_cameras();
  const CameraEntry* found = found_again(identity_, others_, cameras);
  // It may not be ready yet, or another program has opened it: tried again at the next look.
  if (found == nullptr || !start(found->path)) return FrameState::kGone;
  return FrameState::kBack;
}

void V4l2Camera::count(const RawPicture& picture) {
  if (driver_sequence_) {
    const std::uint32_t step = picture.sequence - *driver_sequence_;
    // Some drivers do not count, and some begin again: neither is a gap.
    const bool is_gap = step > 1 && step < (1u << 31);
    if (is_gap) counters_.lost += step - 1;
    sequence_ += is_gap ? step : 1;
  } else {
    ++sequence_;
  }
  driver_sequence_ = picture.sequence;
}

// False: no complete one waits. All others that waited are returned to the driver.
bool V4l2Camera::take_newest(RawPicture& newest) {
  bool has_one = false;
  RawPicture taken;
  waited_ = 0;
  // Bounded: a driver may fill buffers as fast as they are returned.
  while (waited_ < 2 * stream_->buffer_count() && stream_->take(taken) == V4l2Stream::Ready::kYes) {
    ++waited_;
    count(taken);
    if (taken.is_damaged) {
      ++counters_.damaged;
      stream_->give_back(taken);
      continue;
    }
    if (has_one) {
      ++counters_.outrun;
      stream_->give_back(newest);
    }
    newest = taken;
    has_one = true;
  }
  return has_one;
}

// With all buffers full a driver drops newer pictures: those that waited are as old as the last
// read.
bool V4l2Camera::is_stale(const RawPicture& picture, MonoTime now) const {
  if (is_refreshing_ || waited_ < stream_->buffer_count()) return false;
  const double hz = stream_->mode().hz() > 0.0 ? stream_->mode().hz() : 30.0;
  return !picture.is_stamp_monotonic || !has_driver_stamps_ ||
         now - picture.stamp > Duration::period_of_hz(hz);
}

// Some cameras stall behind a hub of too little power and work again when they are reopened.
bool V4l2Camera::is_stalled(MonoTime now) const {
  const double hz = stream_->mode().hz();
  const Duration pictures = hz > 0.0 ? Duration::period_of_hz(hz) * 5 : Duration();
  return now - alive_at_ > std::max(timeouts_.stalled_after, pictures);
}

bool V4l2Camera::show(const RawPicture& picture, Frame& out) {
  const MonoTime now = mono_now();
  const bool is_believable = picture.is_stamp_monotonic && picture.stamp <= now &&
                             now - picture.stamp < kOldest && picture.stamp >= shown_time_;
  // One clock for a stream: alternating between two would make times go back.
  has_driver_stamps_ = has_driver_stamps_ && is_believable;
  cv::Mat& picture_now = pictures_.unheld();
  if (!convert_->convert(picture.bytes, picture_now)) {
    ++counters_.damaged;
    return false;
  }
  out.image = picture_now;
  out.capture_time = shown_time_ = has_driver_stamps_ ? picture.stamp : now;
  out.fetched = now;
  out.sequence = sequence_;
  ++counters_.taken;
  return true;
}

FrameState V4l2Camera::next(Duration timeout, Frame& out) {
  const MonoTime deadline = mono_now() + timeout;
  if (!stream_) return look_again(deadline);
  out.image.release();
  for (MonoTime now = mono_now();; now = mono_now()) {
    switch (stream_->wait(std::max(Duration(), deadline - now))) {
      case V4l2Stream::Ready::kGone:
        lose();
        return FrameState::kGone;
      case V4l2Stream::Ready::kNo:
        if (!is_stalled(mono_now())) return FrameState::kNone;
        lose();
        return FrameState::kGone;
      case V4l2Stream::Ready::kYes:
        break;
    }
    alive_at_ = mono_now();
    RawPicture newest;
    if (take_newest(newest)) {
      if (is_stale(newest, mono_now())) {
        is_refreshing_ = true;
        ++counters_.outrun;
        stream_->give_back(newest);
        continue;
      }
      const bool is_shown = show(newest, out);
      stream_->give_back(newest);
      if (is_shown) {
        is_refreshing_ = false;
        return FrameState::kFrame;
      }
    }
    if (mono_now() >= deadline) return FrameState::kNone;
  }
}

}  // namespace dance
