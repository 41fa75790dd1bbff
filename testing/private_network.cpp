#include "testing/private_network.h"

#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

namespace dance {
namespace {

std::string refused(const char* what) {
  std::array<char, 128> text{};
  return std::string("no private network: ") + what + ": " +
         strerror_r(errno, text.data(), text.size());
}

bool write_file(const char* path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  return static_cast<bool>(file.flush());
}

// Without root, a user namespace in which we are root brings the right to make a network namespace.
Result<void> unshare_network() {
  if (unshare(CLONE_NEWNET) == 0) return {};
  if (errno != EPERM) return fail(refused("unshare"));
  const std::string uid = std::to_string(getuid());
  const std::string gid = std::to_string(getgid());
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0)
    return fail(refused("unshare (sysctl kernel.unprivileged_userns_clone=1 may allow it)"));
  if (!write_file("/proc/self/setgroups", "deny") ||
      !write_file("/proc/self/uid_map", uid + " " + uid + " 1") ||
      !write_file("/proc/self/gid_map", gid + " " + gid + " 1"))
    return fail(refused("user map"));
  return {};
}

Result<void> set_up_loopback(int fd) {
  ifreq device{};
  std::strcpy(device.ifr_name, "lo");  // NOLINT: fits
  if (ioctl(fd, SIOCGIFFLAGS, &device) != 0) return fail(refused("lo"));
  device.ifr_flags = static_cast<short>(device.ifr_flags | IFF_UP | IFF_MULTICAST);
  if (ioctl(fd, SIOCSIFFLAGS, &device) != 0) return fail(refused("lo up"));

  const auto put = [](sockaddr& out, std::uint32_t address) {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    in.sin_addr.s_addr = htonl(address);
    std::memcpy(&out, &in, sizeof in);
  };
  rtentry route{};
  put(route.rt_dst, 0xe0000000);      // 224.0.0.0
  put(route.rt_genmask, 0xf0000000);  // /4
  route.rt_flags = RTF_UP;
  route.rt_dev = device.ifr_name;
  if (ioctl(fd, SIOCADDRT, &route) != 0) return fail(refused("route for multicast"));
  return {};
}

}  // namespace

Result<void> enter_private_network() {
  if (auto unshared = unshare_network(); !unshared) return unshared;
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return fail(refused("socket"));
  auto result = set_up_loopback(fd);
  close(fd);
  return result;
}

}  // namespace dance
