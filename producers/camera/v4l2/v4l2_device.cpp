#include "producers/camera/v4l2/v4l2_device.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

namespace dance {
namespace {

// Bound of what is listed of a driver's answers.
constexpr std::uint32_t kMaxEntries = 256;

std::string text_of_field(const __u8* bytes, std::size_t size) {
  const char* text = reinterpret_cast<const char*>(bytes);
  return {text, strnlen(text, size)};
}

DeviceTrouble open_trouble(const std::string& path, int number) {
  DeviceTrouble trouble{number, false, path + ": "};
  switch (number) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      trouble.what += "there is no such camera";
      break;
    case EACCES:
    case EPERM:
      trouble.what +=
          "no permission; be in the group video (sudo usermod -aG video $USER, then log in again)";
      break;
    case EBUSY:
      trouble.what += "in use; close the program that has it (fuser -v " + path + " names it)";
      break;
    default:
      trouble.what += std::string("cannot be opened: ") + std::strerror(number);
  }
  return trouble;
}

void add_rates(const V4l2Device& device, VideoMode mode, const CameraWish& wish,
               std::vector<VideoMode>& modes) {
  const std::size_t before = modes.size();
  const auto add = [&](std::uint32_t numerator, std::uint32_t denominator) {
    if (numerator == 0 || denominator == 0) return;
    mode.interval_numerator = numerator;
    mode.interval_denominator = denominator;
    if (std::find(modes.begin(), modes.end(), mode) == modes.end()) modes.push_back(mode);
  };
  for (std::uint32_t index = 0; index < kMaxEntries; ++index) {
    v4l2_frmivalenum entry{};
    entry.index = index;
    entry.pixel_format = mode.fourcc;
    entry.width = static_cast<__u32>(mode.width_px);
    entry.height = static_cast<__u32>(mode.height_px);
    if (device.call(VIDIOC_ENUM_FRAMEINTERVALS, &entry) != 0) break;
    if (entry.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      add(entry.discrete.numerator, entry.discrete.denominator);
      continue;
    }
    // Any rate between two: the fastest and slowest, and of the usual and the wished for those that
    // lie between.
    const v4l2_fract least = entry.stepwise.min;
    const v4l2_fract most = entry.stepwise.max;
    if (least.denominator == 0 || most.denominator == 0) break;
    add(least.numerator, least.denominator);
    add(most.numerator, most.denominator);
    const double shortest_s = static_cast<double>(least.numerator) / least.denominator;
    const double longest_s = static_cast<double>(most.numerator) / most.denominator;
    for (const double hz : {60.0, 30.0, wish.hz.value_or(30.0)}) {
      if (hz > 0.0 && 1.0 / hz >= shortest_s && 1.0 / hz <= longest_s) {
        add(1000, static_cast<std::uint32_t>(hz * 1000.0 + 0.5));
      }
    }
    break;
  }
  if (modes.size() == before) modes.push_back(mode);
}

int stepped(int wanted, const __u32 least, const __u32 most, const __u32 step) {
  const int bounded = std::clamp(wanted, static_cast<int>(least), static_cast<int>(most));
  const int by = step == 0 ? 1 : static_cast<int>(step);
  return static_cast<int>(least) + (bounded - static_cast<int>(least)) / by * by;
}

void add_sizes(const V4l2Device& device, std::uint32_t fourcc, const CameraWish& wish,
               std::vector<VideoMode>& modes) {
  const std::size_t before = modes.size();
  constexpr int kLargest_px = 1 << 15;
  const auto add = [&](int width_px, int height_px) {
    if (width_px <= 0 || height_px <= 0 || width_px > kLargest_px || height_px > kLargest_px)
      return;
    add_rates(device, {fourcc, width_px, height_px, 0, 0}, wish, modes);
  };
  for (std::uint32_t index = 0; index < kMaxEntries; ++index) {
    v4l2_frmsizeenum entry{};
    entry.index = index;
    entry.pixel_format = fourcc;
    if (device.call(VIDIOC_ENUM_FRAMESIZES, &entry) != 0) break;
    if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      add(static_cast<int>(entry.discrete.width), static_cast<int>(entry.discrete.height));
      continue;
    }
    const auto& s = entry.stepwise;
    if (s.max_width > kLargest_px || s.max_height > kLargest_px || s.min_width > s.max_width ||
        s.min_height > s.max_height) {
      break;
    }
    const std::pair<int, int> sizes[] = {
        {wish.width_px.value_or(1280), wish.height_px.value_or(720)},
        {1280, 720},
        {640, 480},
        {static_cast<int>(s.max_width), static_cast<int>(s.max_height)}};
    for (const auto& [width_px, height_px] : sizes) {
      add(stepped(width_px, s.min_width, s.max_width, s.step_width),
          stepped(height_px, s.min_height, s.max_height, s.step_height));
    }
    break;
  }
  if (modes.size() != before) return;
  // A driver that lists no sizes has one: what is set.
  v4l2_format now{};
  now.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (device.call(VIDIOC_G_FMT, &now) == 0) {
    add(static_cast<int>(now.fmt.pix.width), static_cast<int>(now.fmt.pix.height));
  }
}

}  // namespace

tl::expected<V4l2Device, DeviceTrouble> V4l2Device::open(const std::string& path) {
  V4l2Device device;
  device.path_ = path;
  device.fd_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (device.fd_ < 0) return tl::make_unexpected(open_trouble(path, errno));
  v4l2_capability can{};
  if (const int number = device.call(VIDIOC_QUERYCAP, &can); number != 0) {
    if (number == ENODEV) return tl::make_unexpected(open_trouble(path, number));
    return tl::make_unexpected(DeviceTrouble{
        number, false,
        path + ": is no video device; cameras are called /dev/video0, /dev/video1, …"});
  }
  device.card_ = text_of_field(can.card, sizeof can.card);
  device.bus_info_ = text_of_field(can.bus_info, sizeof can.bus_info);
  if (device.card_.empty()) device.card_ = "camera";
  // `capabilities` is of the whole device: a camera's node for metadata claims there to capture
  // pictures.
  const __u32 caps = (can.capabilities & V4L2_CAP_DEVICE_CAPS) ? can.device_caps : can.capabilities;
  if ((caps & V4L2_CAP_VIDEO_CAPTURE) == 0) {
    const bool is_planar = (caps & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0;
    return tl::make_unexpected(DeviceTrouble{
        0, !is_planar,
        device.name() + (is_planar
                             ? ": gives pictures in several planes each, which is not supported; "
                               "take a USB camera, or the raw device behind it"
                             : ": gives no pictures; a camera often has a second device beside "
                               "the one for pictures: try its neighbour")});
  }
  if ((caps & V4L2_CAP_STREAMING) == 0) {
    return tl::make_unexpected(DeviceTrouble{
        0, false, device.name() + ": cannot stream, which is needed; take another camera"});
  }
  return device;
}

V4l2Device::V4l2Device(V4l2Device&& other) noexcept { *this = std::move(other); }

V4l2Device& V4l2Device::operator=(V4l2Device&& other) noexcept {
  std::swap(fd_, other.fd_);
  path_.swap(other.path_);
  card_.swap(other.card_);
  bus_info_.swap(other.bus_info_);
  return *this;
}

V4l2Device::~V4l2Device() {
  if (fd_ >= 0) ::close(fd_);
}

int V4l2Device::call(unsigned long request, void* argument) const {
  for (;;) {
    if (::ioctl(fd_, request, argument) == 0) return 0;
    if (errno != EINTR) return errno;
  }
}

std::vector<VideoMode> V4l2Device::modes(const CameraWish& wish) const {
  std::vector<VideoMode> all;
  for (std::uint32_t index = 0; index < kMaxEntries; ++index) {
    v4l2_fmtdesc entry{};
    entry.index = index;
    entry.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (call(VIDIOC_ENUM_FMT, &entry) != 0) break;
    add_sizes(*this, entry.pixelformat, wish, all);
  }
  return all;
}

std::string holders_of(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code trouble;
  const fs::path wanted = fs::canonical(path, trouble);
  if (trouble) return "";
  std::string all;
  const std::string self = std::to_string(::getpid());
  for (fs::directory_iterator process("/proc", trouble), end; !trouble && process != end;
       process.increment(trouble)) {
    const std::string pid = process->path().filename();
    if (pid.find_first_not_of("0123456789") != std::string::npos || pid == self) continue;
    std::error_code ignored;
    for (fs::directory_iterator file(process->path() / "fd", ignored); !ignored && file != end;
         file.increment(ignored)) {
      std::error_code gone;
      if (fs::read_symlink(file->path(), gone) != wanted || gone) continue;
      std::ifstream name_file(process->path() / "comm");
      std::string name = "a program";
      std::getline(name_file, name);
      all += (all.empty() ? "" : ", ") + name + " (" + pid + ")";
      break;
    }
  }
  return all;
}

}  // namespace dance
