// What the shim's driver answers about formats and buffers.
#include <linux/videodev2.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <vector>

#include "tests/producers/camera/v4l2/shim_device.h"

namespace dance {
namespace {

constexpr std::size_t kPage_bytes = 4096;

void describe(const ShimMode& mode, int pad_bytes, v4l2_pix_format& pix) {
  pix = {};
  pix.pixelformat = mode.fourcc;
  pix.width = static_cast<__u32>(mode.width_px);
  pix.height = static_cast<__u32>(mode.height_px);
  pix.field = V4L2_FIELD_NONE;
  pix.bytesperline = is_jpeg_mode(mode) ? 0 : static_cast<__u32>(row_bytes(mode) + pad_bytes);
  pix.sizeimage = static_cast<__u32>(picture_bytes(mode, pad_bytes));
}

}  // namespace

int ShimDevice::enumerate(unsigned long request, void* argument) const {
  const ShimFree& free = words_.free;
  if (request == VIDIOC_ENUM_FMT) {
    auto& entry = *static_cast<v4l2_fmtdesc*>(argument);
    std::vector<std::uint32_t> all;
    const auto add = [&all](std::uint32_t fourcc) {
      if (std::find(all.begin(), all.end(), fourcc) == all.end()) all.push_back(fourcc);
    };
    for (const ShimMode& mode : words_.modes) add(mode.fourcc);
    if (free.step_px > 0) add(free.most.fourcc);
    if (entry.index >= all.size()) return EINVAL;
    entry.pixelformat = all[entry.index];
    return 0;
  }
  if (request == VIDIOC_ENUM_FRAMESIZES) {
    auto& entry = *static_cast<v4l2_frmsizeenum*>(argument);
    if (free.step_px > 0 && entry.pixel_format == free.most.fourcc) {
      if (entry.index != 0) return EINVAL;
      const auto step = static_cast<__u32>(free.step_px);
      entry.type = V4L2_FRMSIZE_TYPE_STEPWISE;
      entry.stepwise = {
          static_cast<__u32>(free.least.width_px),  static_cast<__u32>(free.most.width_px),  step,
          static_cast<__u32>(free.least.height_px), static_cast<__u32>(free.most.height_px), step};
      return 0;
    }
    std::uint32_t index = 0;
    std::vector<std::pair<int, int>> seen;
    for (const ShimMode& mode : words_.modes) {
      const std::pair<int, int> size{mode.width_px, mode.height_px};
      if (mode.fourcc != entry.pixel_format ||
          std::find(seen.begin(), seen.end(), size) != seen.end())
        continue;
      seen.push_back(size);
      if (index++ != entry.index) continue;
      entry.type = V4L2_FRMSIZE_TYPE_DISCRETE;
      entry.discrete = {static_cast<__u32>(mode.width_px), static_cast<__u32>(mode.height_px)};
      return 0;
    }
    return EINVAL;
  }
  auto& entry = *static_cast<v4l2_frmivalenum*>(argument);
  if (free.step_px > 0 && entry.pixel_format == free.most.fourcc) {
    if (entry.index != 0) return EINVAL;
    entry.type = V4L2_FRMIVAL_TYPE_STEPWISE;
    entry.stepwise = {{1, static_cast<__u32>(free.most.hz)}, {1, 1}, {1, 1000}};
    return 0;
  }
  std::uint32_t index = 0;
  for (const ShimMode& mode : words_.modes) {
    if (mode.fourcc != entry.pixel_format || mode.width_px != static_cast<int>(entry.width) ||
        mode.height_px != static_cast<int>(entry.height) || mode.hz == 0 ||
        index++ != entry.index) {
      continue;
    }
    entry.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    entry.discrete = {1, static_cast<__u32>(mode.hz)};
    return 0;
  }
  return EINVAL;
}

int ShimDevice::answer_format(int fd, unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_ENUM_FMT:
    case VIDIOC_ENUM_FRAMESIZES:
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return enumerate(request, argument);
    case VIDIOC_S_FMT: {
      if (is_of_another(fd)) return EBUSY;
      auto& format = *static_cast<v4l2_format*>(argument);
      now_ = words_.makes;
      if (now_.fourcc == 0) {
        now_ = {format.fmt.pix.pixelformat, static_cast<int>(format.fmt.pix.width),
                static_cast<int>(format.fmt.pix.height), 30};
      }
      describe(now_, words_.pad_bytes, format.fmt.pix);
      return 0;
    }
    case VIDIOC_G_FMT:
      if (now_.fourcc == 0 && !words_.modes.empty()) now_ = words_.modes.front();
      describe(now_, words_.pad_bytes, static_cast<v4l2_format*>(argument)->fmt.pix);
      return 0;
    case VIDIOC_S_PARM: {
      if (is_of_another(fd)) return EBUSY;
      const v4l2_fract period = static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe;
      if (words_.makes.fourcc == 0 && period.numerator != 0) {
        now_.hz = static_cast<int>(period.denominator / period.numerator);
      }
      return 0;
    }
    case VIDIOC_G_PARM:
      static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {
          now_.hz == 0 ? 0u : 1u, static_cast<__u32>(now_.hz)};
      return 0;
    default:
      return ENOTTY;
  }
}

int ShimDevice::answer_stream(int fd, unsigned long request, void* argument) {
  if (is_of_another(fd)) return EBUSY;
  switch (request) {
    case VIDIOC_REQBUFS: {
      auto& wanted = *static_cast<v4l2_requestbuffers*>(argument);
      if (owner_ == fd) return EBUSY;  // ours ask once
      const std::size_t whole = picture_bytes(now_, words_.pad_bytes);
      buffer_bytes_ = (whole + kPage_bytes - 1) / kPage_bytes * kPage_bytes;
      wanted.count = std::min(wanted.count, 8u);
      memory_fd_ = ::memfd_create("dance_video_shim", MFD_CLOEXEC);
      const std::size_t size = buffer_bytes_ * wanted.count;
      if (memory_fd_ < 0 || ::ftruncate(memory_fd_, static_cast<off_t>(size)) != 0) std::abort();
      // Not by mmap(), which is ours. A system call takes all of it as long.
      const long memory =
          ::syscall(SYS_mmap, 0L, static_cast<long>(size), long{PROT_READ | PROT_WRITE},
                    long{MAP_SHARED}, static_cast<long>(memory_fd_), 0L);
      if (memory == -1) std::abort();
      memory_ = reinterpret_cast<std::uint8_t*>(memory);
      buffers_.assign(wanted.count, {});
      empty_.reserve(wanted.count);
      full_.reserve(wanted.count);
      owner_ = fd;
      return 0;
    }
    case VIDIOC_STREAMON:
      is_streaming_ = true;
      sequence_ = 0;
      return 0;
    case VIDIOC_STREAMOFF:
      stop_stream();
      return 0;
    case VIDIOC_QUERYBUF:
    case VIDIOC_QBUF: {
      auto& buffer = *static_cast<v4l2_buffer*>(argument);
      if (owner_ != fd || buffer.index >= buffers_.size()) return EINVAL;
      if (request == VIDIOC_QUERYBUF) {
        buffer.length = static_cast<__u32>(buffer_bytes_);
        buffer.m.offset = static_cast<__u32>(buffer.index * buffer_bytes_);
        return 0;
      }
      if (buffers_[buffer.index].is_queued) return EINVAL;  // given back twice
      buffers_[buffer.index].is_queued = true;
      empty_.push_back(buffer.index);
      return 0;
    }
    case VIDIOC_DQBUF: {
      if (owner_ != fd) return EINVAL;
      if (full_.empty()) return EAGAIN;
      char byte = 0;
      if (::read(fd, &byte, 1) != 1) std::abort();
      auto& out = *static_cast<v4l2_buffer*>(argument);
      out.index = full_.front();
      full_.erase(full_.begin());
      ++fetched_;
      Buffer& buffer = buffers_[out.index];
      buffer.is_queued = false;
      out.bytesused = buffer.used;
      out.sequence = buffer.sequence;
      out.flags = buffer.flags;
      out.timestamp = {buffer.stamp_us / 1'000'000, buffer.stamp_us % 1'000'000};
      return 0;
    }
    default:
      return ENOTTY;
  }
}

}  // namespace dance
