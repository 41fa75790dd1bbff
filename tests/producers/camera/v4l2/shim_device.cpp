#include "tests/producers/camera/v4l2/shim_device.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <thread>

namespace dance {
namespace {

constexpr const char* kStart = "/dev/video";
std::atomic<int> handle_count = 0;

void sleep_ms(int ms) {
  const timespec time{ms / 1000, (ms % 1000) * 1'000'000L};
  ::nanosleep(&time, nullptr);
}

std::int64_t clock_us(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * 1'000'000 + t.tv_nsec / 1'000;
}

void real_close(int fd) { ::syscall(SYS_close, static_cast<long>(fd)); }

}  // namespace

ShimDevice& ShimDevice::here() {
  static ShimDevice* const device =
      new ShimDevice;  // never destroyed: files are closed after everything
  return *device;
}

int ShimDevice::open_handles() { return handle_count.load(std::memory_order_relaxed); }

bool ShimDevice::is_video(const char* path) {
  return std::strncmp(path, kStart, std::strlen(kStart)) == 0;
}

ShimDevice::ShimDevice() {
  // Who forks while the sensor runs must not find the lock taken for ever in the child, whose first
  // act is to close files.
  ::pthread_atfork([] { here().lock_.lock(); }, [] { here().lock_.unlock(); },
                   [] { here().lock_.unlock(); });
  const char* words = std::getenv("DANCE_VIDEO_SHIM");
  if (words == nullptr) {
    words_.is_absent = true;
    return;
  }
  words_.read(words);
  is_plugged_ = !words_.is_absent;
  if (!words_.file.empty() && !words_.modes.empty()) {
    pictures_ = read_pictures(words_.file, words_.modes.front());
  }
  if (words_.hz > 0) std::thread([this] { run_by_itself(); }).detach();
}

void ShimDevice::run_by_itself() {
  const std::int64_t period_us = 1'000'000 / words_.hz;
  bool was_unplugged = false;
  bool is_first = true;
  for (std::int64_t due_us = clock_us(CLOCK_MONOTONIC);; due_us += period_us) {
    const timespec due{due_us / 1'000'000, (due_us % 1'000'000) * 1'000};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
    bool is_on = false;
    int fetched = 0;
    {
      const std::lock_guard guard(lock_);
      is_on = is_streaming_;
      fetched = fetched_;
    }
    if (!is_on) continue;
    if (is_first) sleep_ms(words_.slow_start_ms);
    is_first = false;
    tick(1);
    if (words_.unplug_after > 0 && fetched >= words_.unplug_after && !was_unplugged) {
      was_unplugged = true;
      unplug();
      sleep_ms(words_.replug_ms);
      if (words_.again >= 0) words_.device = words_.again;
      if (words_.replug_ms > 0) plug();
      due_us = clock_us(CLOCK_MONOTONIC);
    }
  }
}

void ShimDevice::set_up(const char* words) {
  unplug();
  const std::lock_guard guard(lock_);
  words_ = {};
  words_.read(words);
  pictures_.clear();
  now_ = {};
  newest_stamp_us_ = 0;
  is_plugged_ = !words_.is_absent;
}

void ShimDevice::change(const char* words) {
  const std::lock_guard guard(lock_);
  words_.read(words);
}

void ShimDevice::add_picture(const std::uint8_t* bytes, std::size_t size) {
  const std::lock_guard guard(lock_);
  pictures_.emplace_back(bytes, bytes + size);
}

void ShimDevice::tick(int n) {
  const std::lock_guard guard(lock_);
  for (int i = 0; i < n; ++i) tick_once();
}

void ShimDevice::tick_once() {
  if (!is_streaming_) return;
  const std::uint32_t sequence = sequence_++;
  if (words_.gaps.contains(sequence) || empty_.empty()) return;
  const std::uint32_t index = empty_.front();
  empty_.erase(empty_.begin());
  fill(index, sequence);
  full_.push_back(index);
  const char byte = 0;
  if (::write(handles_[owner_].write_fd, &byte, 1) != 1) std::abort();
}

void ShimDevice::fill(std::uint32_t index, std::uint32_t sequence) {
  Buffer& buffer = buffers_[index];
  buffer.sequence = sequence;
  buffer.flags = words_.errors.contains(sequence) ? V4L2_BUF_FLAG_ERROR : 0;
  buffer.stamp_us = clock_us(words_.stamp == "realtime" ? CLOCK_REALTIME : CLOCK_MONOTONIC) -
                    std::int64_t{words_.age_ms} * 1'000;
  if (words_.stamp == "monotonic") buffer.flags |= V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  if (words_.stamp == "zero") buffer.stamp_us = 0;
  newest_stamp_us_ = buffer.stamp_us;
  std::uint8_t* to = memory_ + index * buffer_bytes_;
  std::size_t used = 0;
  if (!pictures_.empty()) {
    const std::vector<std::uint8_t>& picture = pictures_[sequence % pictures_.size()];
    const auto row = static_cast<std::size_t>(row_bytes(now_));
    if (row == 0) {
      used = std::min(picture.size(), buffer_bytes_);
      std::memcpy(to, picture.data(), used);
    } else {
      const std::size_t stride = row + static_cast<std::size_t>(words_.pad_bytes);
      for (std::size_t at = 0; at + row <= picture.size() && used + stride <= buffer_bytes_;
           at += row) {
        std::memcpy(to + used, picture.data() + at, row);
        std::memset(to + used + row, 0xa5, static_cast<std::size_t>(words_.pad_bytes));
        used += stride;
      }
    }
  }
  buffer.used = static_cast<std::uint32_t>(words_.cut.contains(sequence) ? used / 2 : used);
}

void ShimDevice::stop_stream() {
  is_streaming_ = false;
  empty_.clear();
  // What waits is taken back, and with it what poll() would tell of it.
  char byte = 0;
  while (!full_.empty()) {
    if (owner_ >= 0 && ::read(owner_, &byte, 1) != 1) break;
    full_.erase(full_.begin());
  }
  full_.clear();
  for (Buffer& buffer : buffers_) buffer.is_queued = false;
}

void ShimDevice::unplug() {
  const std::lock_guard guard(lock_);
  stop_stream();
  is_plugged_ = false;
  for (auto& [fd, handle] : handles_) {
    if (handle.write_fd >= 0) real_close(handle.write_fd);
    handle.write_fd = -1;
  }
}

void ShimDevice::plug() {
  const std::lock_guard guard(lock_);
  is_plugged_ = true;
  if (owner_ >= 0 && handles_[owner_].write_fd < 0) owner_ = -1;
}

std::int64_t ShimDevice::newest_stamp_us() const {
  const std::lock_guard guard(lock_);
  return newest_stamp_us_;
}
int ShimDevice::free_buffers() const {
  const std::lock_guard guard(lock_);
  return static_cast<int>(empty_.size());
}
int ShimDevice::open_files() const {
  const std::lock_guard guard(lock_);
  return static_cast<int>(handles_.size());
}
int ShimDevice::priority() const {
  const std::lock_guard guard(lock_);
  return words_.priority;
}

int ShimDevice::open(const char* path, int flags) {
  const std::lock_guard guard(lock_);
  const std::string number = path + std::strlen(kStart);
  const bool is_metadata = words_.has_metadata && number == std::to_string(words_.device + 1);
  if (!is_metadata && number != std::to_string(words_.device)) return -2;
  if (!is_plugged_) {
    errno = ENOENT;
    return -1;
  }
  if (words_.is_denied) {
    errno = EACCES;
    return -1;
  }
  int ends[2] = {};
  if (::pipe2(ends, O_CLOEXEC | (flags & O_NONBLOCK)) != 0) return -1;
  handles_[ends[0]] = {ends[1], is_metadata};
  ++handle_count;
  return ends[0];
}

bool ShimDevice::is_ours(int fd) const {
  const std::lock_guard guard(lock_);
  return handles_.contains(fd);
}

void ShimDevice::close(int fd) {
  const std::lock_guard guard(lock_);
  const Handle handle = handles_[fd];
  if (owner_ == fd) {
    stop_stream();
    if (memory_ != nullptr) ::munmap(memory_, buffer_bytes_ * buffers_.size());
    if (memory_fd_ >= 0) real_close(memory_fd_);
    memory_ = nullptr;
    memory_fd_ = -1;
    buffers_.clear();
    owner_ = -1;
  }
  if (handle.write_fd >= 0) real_close(handle.write_fd);
  handles_.erase(fd);
  --handle_count;
}

int ShimDevice::memory_of(int fd) const {
  const std::lock_guard guard(lock_);
  return fd == owner_ && handles_.contains(fd) ? memory_fd_ : -1;
}

int ShimDevice::answer(int fd, unsigned long request, void* argument) {
  const std::lock_guard guard(lock_);
  const Handle& handle = handles_[fd];
  if (handle.write_fd < 0) return ENODEV;
  if (request == VIDIOC_QUERYCAP) {
    auto& can = *static_cast<v4l2_capability*>(argument);
    can = {};
    std::strncpy(reinterpret_cast<char*>(can.driver), "shim", sizeof can.driver - 1);
    std::strncpy(reinterpret_cast<char*>(can.card), words_.card.c_str(), sizeof can.card - 1);
    std::strncpy(reinterpret_cast<char*>(can.bus_info), words_.bus.c_str(),
                 sizeof can.bus_info - 1);
    can.device_caps =
        V4L2_CAP_STREAMING | (handle.is_metadata ? V4L2_CAP_META_CAPTURE : V4L2_CAP_VIDEO_CAPTURE);
    can.capabilities =
        V4L2_CAP_STREAMING | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_META_CAPTURE | V4L2_CAP_DEVICE_CAPS;
    return 0;
  }
  if (handle.is_metadata) return EINVAL;
  if (request == VIDIOC_G_CTRL || request == VIDIOC_S_CTRL) {
    auto& control = *static_cast<v4l2_control*>(argument);
    if (control.id != V4L2_CID_EXPOSURE_AUTO_PRIORITY || words_.priority < 0) return EINVAL;
    if (request == VIDIOC_S_CTRL) words_.priority = control.value;
    control.value = words_.priority;
    return 0;
  }
  const int number = answer_format(fd, request, argument);
  return number == ENOTTY ? answer_stream(fd, request, argument) : number;
}

}  // namespace dance
