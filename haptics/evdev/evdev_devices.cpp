#include "haptics/evdev/evdev_devices.h"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/printable.h"

namespace dance {
namespace {

constexpr std::size_t kMostDevices = 256;
constexpr std::size_t kBitsPerLong = 8 * sizeof(unsigned long);

bool has_bit(const std::array<unsigned long, (FF_MAX + kBitsPerLong) / kBitsPerLong>& bits,
             unsigned bit) {
  return ((bits[bit / kBitsPerLong] >> (bit % kBitsPerLong)) & 1u) != 0;
}

}  // namespace

bool may_rumble(const std::string& event, const std::string& classes) {
  const std::string path = classes + "/" + event + "/device/capabilities/ff";
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return true;
  // Words in hexadecimal; a keyboard has "0".
  std::array<char, 256> text{};
  const ssize_t size = read(fd, text.data(), text.size());
  close(fd);
  return size < 0 || std::any_of(text.begin(), text.begin() + size, [](char c) {
           return c != '0' && std::isxdigit(static_cast<unsigned char>(c)) != 0;
         });
}

std::vector<EvdevDevice> list_evdev_devices(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<EvdevDevice> devices;
  std::error_code error;
  std::vector<std::string> paths;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with("event") && paths.size() < kMostDevices && may_rumble(name))
      paths.push_back(entry->path().string());
  }
  std::sort(paths.begin(), paths.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  for (const std::string& path : paths) {
    EvdevDevice device;
    device.path = path;
    int fd = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    const int refused = fd < 0 ? errno : 0;
    // To say what it is, reading is enough.
    if (fd < 0) fd = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) continue;
    std::array<char, 128> name{};
    ioctl(fd, EVIOCGNAME(name.size() - 1), name.data());
    device.name = printable(name.data());
    std::array<unsigned long, (FF_MAX + kBitsPerLong) / kBitsPerLong> bits{};
    if (ioctl(fd, EVIOCGBIT(EV_FF, sizeof bits), bits.data()) >= 0) {
      device.rumbles = has_bit(bits, FF_RUMBLE);
      device.has_waves = has_bit(bits, FF_PERIODIC) && has_bit(bits, FF_SINE);
      ioctl(fd, EVIOCGEFFECTS, &device.effects);
    }
    close(fd);
    if (!device.rumbles && !device.has_waves) continue;
    if (refused == EACCES || refused == EPERM)
      device.trouble = "may not be written: join the group input, or add a udev rule";
    else if (refused != 0)
      device.trouble = "cannot be opened for writing";
    devices.push_back(device);
  }
  return devices;
}

}  // namespace dance
