#include "producers/camera/v4l2/v4l2_stream.h"

#include <linux/videodev2.h>
#include <poll.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

namespace dance {
namespace {

// One being filled, one being read, two for a reader that is late.
constexpr __u32 kBuffers = 4;
constexpr int kMaxTroubles = 50;  // one after the other
constexpr __u32 kType = V4L2_BUF_TYPE_VIDEO_CAPTURE;

Error trouble_of(const V4l2Device& device, const std::string& what, int number) {
  if (number == EBUSY) {
    const std::string who = holders_of(device.path());
    return {device.name() + ": in use by " +
            (who.empty() ? "another program; close it (fuser -v " + device.path() + " names it)"
                         : who + "; close that")};
  }
  if (number == ENODEV) return {device.name() + ": was unplugged; plug it in again"};
  std::string cure = "; try another size with the wish for it, or plug the camera in again";
  if (number == ENOSPC) {
    cure = "; the USB bus has no room for it: take another socket, a smaller size or MJPG";
  }
  return {device.name() + ": " + what + ": " + std::strerror(number) + cure};
}

bool is_in_range(std::uint32_t value) {
  return value > 0 && value <= std::uint32_t{std::numeric_limits<std::int16_t>::max()};
}

}  // namespace

Result<V4l2Stream> V4l2Stream::start(V4l2Device device, const CameraWish& wish) {
  V4l2Stream stream(std::move(device));
  if (auto done = stream.negotiate(wish); !done) return tl::make_unexpected(done.error());
  if (auto done = stream.map_buffers(); !done) return tl::make_unexpected(done.error());
  stream.hold_the_rate();
  __u32 type = kType;
  if (const int number = stream.device_.call(VIDIOC_STREAMON, &type); number != 0) {
    return tl::make_unexpected(trouble_of(stream.device_, "does not start", number));
  }
  stream.is_streaming_ = true;
  return stream;
}

Result<void> V4l2Stream::negotiate(const CameraWish& wish) {
  const std::vector<VideoMode> modes = device_.modes(wish);
  const auto chosen = choose_mode(modes, wish);
  if (!chosen) return fail(device_.name() + ": " + chosen.error().what);

  v4l2_format format{};
  format.type = kType;
  format.fmt.pix.pixelformat = chosen->fourcc;
  format.fmt.pix.width = static_cast<__u32>(chosen->width_px);
  format.fmt.pix.height = static_cast<__u32>(chosen->height_px);
  format.fmt.pix.field = V4L2_FIELD_NONE;
  if (const int number = device_.call(VIDIOC_S_FMT, &format); number != 0) {
    return tl::make_unexpected(trouble_of(device_, "refuses " + text_of(*chosen), number));
  }
  v4l2_streamparm rate{};
  rate.type = kType;
  if (chosen->interval_numerator != 0) {
    rate.parm.capture.timeperframe = {chosen->interval_numerator, chosen->interval_denominator};
    // A driver that cannot set its rate has one.
    if (const int number = device_.call(VIDIOC_S_PARM, &rate);
        number == EBUSY || number == ENODEV) {
      return tl::make_unexpected(trouble_of(device_, "refuses " + text_of(*chosen), number));
    }
  }
  // A driver may make something else of what it was asked for: what it now says is what comes.
  if (const int number = device_.call(VIDIOC_G_FMT, &format); number != 0) {
    return tl::make_unexpected(trouble_of(device_, "does not say its format", number));
  }
  if (!is_in_range(format.fmt.pix.width) || !is_in_range(format.fmt.pix.height) ||
      format.fmt.pix.bytesperline > (1u << 20)) {
    return fail(device_.name() + ": the driver names an impossible size; plug the camera in again");
  }
  mode_ = *chosen;
  mode_.fourcc = format.fmt.pix.pixelformat;
  mode_.width_px = static_cast<int>(format.fmt.pix.width);
  mode_.height_px = static_cast<int>(format.fmt.pix.height);
  layout_ = {mode_.fourcc, mode_.width_px, mode_.height_px,
             static_cast<int>(format.fmt.pix.bytesperline)};
  rate = {};
  rate.type = kType;
  if (device_.call(VIDIOC_G_PARM, &rate) == 0 && rate.parm.capture.timeperframe.numerator != 0) {
    mode_.interval_numerator = rate.parm.capture.timeperframe.numerator;
    mode_.interval_denominator = rate.parm.capture.timeperframe.denominator;
  }
  return {};
}

Result<void> V4l2Stream::map_buffers() {
  v4l2_requestbuffers request{};
  request.count = kBuffers;
  request.type = kType;
  request.memory = V4L2_MEMORY_MMAP;
  if (const int number = device_.call(VIDIOC_REQBUFS, &request); number != 0) {
    return tl::make_unexpected(trouble_of(device_, "gives no buffers", number));
  }
  if (request.count < 2 || request.count > 32) {
    return fail(device_.name() + ": the driver gives " + std::to_string(request.count) +
                " buffers where " + std::to_string(kBuffers) +
                " were asked for; close other programs and try again");
  }
  for (__u32 index = 0; index < request.count; ++index) {
    v4l2_buffer buffer{};
    buffer.index = index;
    buffer.type = kType;
    buffer.memory = V4L2_MEMORY_MMAP;
    if (const int number = device_.call(VIDIOC_QUERYBUF, &buffer); number != 0) {
      return tl::make_unexpected(trouble_of(device_, "does not name its buffers", number));
    }
    void* memory = ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, device_.fd(),
                          static_cast<off_t>(buffer.m.offset));
    if (memory == MAP_FAILED) {
      return tl::make_unexpected(trouble_of(device_, "does not share its buffers", errno));
    }
    buffers_.push_back({static_cast<std::uint8_t*>(memory), buffer.length});
    if (const int number = device_.call(VIDIOC_QBUF, &buffer); number != 0) {
      return tl::make_unexpected(trouble_of(device_, "does not take its buffers", number));
    }
  }
  return {};
}

// Many cameras expose longer than a picture's time in a dim room, and so come at 15 Hz instead of
// 30.
void V4l2Stream::hold_the_rate() {
  v4l2_control control{};
  control.id = V4L2_CID_EXPOSURE_AUTO_PRIORITY;
  if (device_.call(VIDIOC_G_CTRL, &control) != 0) return;  // it has no such control
  const bool was_free = control.value != 0;
  control.value = 0;
  holds_the_rate_ = !was_free || device_.call(VIDIOC_S_CTRL, &control) == 0;
  must_give_the_rate_free_ = was_free && holds_the_rate_;
}

V4l2Stream::Ready V4l2Stream::wait(Duration timeout) const {
  if (is_gone_) return Ready::kGone;
  pollfd wanted{device_.fd(), POLLIN, 0};
  // A fraction of a millisecond rounds up: rounded down it would wait by spinning.
  const std::int64_t ms =
      std::clamp<std::int64_t>((timeout.count_ns() + 999'999) / 1'000'000, 0, 1 << 30);
  const int ready = ::poll(&wanted, 1, static_cast<int>(ms));
  if (ready <= 0) return Ready::kNo;
  if ((wanted.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) return Ready::kGone;
  return Ready::kYes;
}

V4l2Stream::Ready V4l2Stream::take(RawPicture& out) {
  v4l2_buffer buffer{};
  buffer.type = kType;
  buffer.memory = V4L2_MEMORY_MMAP;
  switch (device_.call(VIDIOC_DQBUF, &buffer)) {
    case 0:
      break;
    case EAGAIN:
      return Ready::kNo;
    case EIO:  // trouble that may pass: a weak signal
      if (++troubles_ < kMaxTroubles) return Ready::kNo;
      [[fallthrough]];
    default:
      is_gone_ = true;
      return Ready::kGone;
  }
  troubles_ = 0;
  if (buffer.index >= buffers_.size()) {
    is_gone_ = true;
    return Ready::kGone;
  }
  const std::size_t used = std::min<std::size_t>(buffer.bytesused, buffers_[buffer.index].size());
  out.bytes = std::span<const std::uint8_t>(buffers_[buffer.index]).first(used);
  out.index = buffer.index;
  out.sequence = buffer.sequence;
  out.stamp = MonoTime::from_ns(std::int64_t{buffer.timestamp.tv_sec} * 1'000'000'000 +
                                std::int64_t{buffer.timestamp.tv_usec} * 1'000);
  out.is_stamp_monotonic =
      (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  out.is_damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0 || used == 0;
  return Ready::kYes;
}

void V4l2Stream::give_back(const RawPicture& picture) {
  v4l2_buffer buffer{};
  buffer.index = picture.index;
  buffer.type = kType;
  buffer.memory = V4L2_MEMORY_MMAP;
  if (device_.call(VIDIOC_QBUF, &buffer) != 0) is_gone_ = true;
}

V4l2Stream::V4l2Stream(V4l2Stream&& other) noexcept
    : device_(std::move(other.device_)),
      mode_(other.mode_),
      layout_(other.layout_),
      buffers_(std::move(other.buffers_)),
      troubles_(other.troubles_),
      is_gone_(other.is_gone_),
      is_streaming_(std::exchange(other.is_streaming_, false)),
      holds_the_rate_(other.holds_the_rate_),
      must_give_the_rate_free_(std::exchange(other.must_give_the_rate_free_, false)) {
  other.buffers_.clear();
}

V4l2Stream::~V4l2Stream() { stop(); }

void V4l2Stream::stop() {
  if (is_streaming_) {
    __u32 type = kType;
    device_.call(VIDIOC_STREAMOFF, &type);
  }
  if (must_give_the_rate_free_) {
    v4l2_control control{};
    control.id = V4L2_CID_EXPOSURE_AUTO_PRIORITY;
    control.value = 1;
    device_.call(VIDIOC_S_CTRL, &control);
  }
  for (const std::span<std::uint8_t> buffer : buffers_) ::munmap(buffer.data(), buffer.size());
  buffers_.clear();
}

}  // namespace dance
