#include "core/bus/route/multicast_route.h"

#include <bit>
#include <cstdint>
#include <fstream>
#include <sstream>

#include "core/bus/bus_url.h"

namespace dance {

std::string multicast_device(std::string_view group, std::string_view routes) {
  const auto wanted = parse_ipv4(group);
  if (!wanted) return "";
  std::istringstream lines{std::string(routes)};
  std::string line, best_device;
  std::getline(lines, line);  // the head of the table
  int best_length = -1;
  while (std::getline(lines, line)) {
    // Iface Destination Gateway Flags RefCnt Use Metric Mask …, addresses in hex, in the byte order
    // of the machine.
    std::istringstream fields(line);
    std::string device;
    std::uint32_t destination = 0, gateway = 0, flags = 0, count = 0, use = 0, metric = 0, mask = 0;
    fields >> device >> std::hex >> destination >> gateway >> flags >> std::dec >> count >> use >>
        metric >> std::hex >> mask;
    if (!fields || !(flags & 1u)) continue;
    if constexpr (std::endian::native == std::endian::little) {
      destination = __builtin_bswap32(destination);
      mask = __builtin_bswap32(mask);
    }
    if ((*wanted & mask) != destination) continue;
    const int length = std::popcount(mask);
    if (length > best_length) {
      best_length = length;
      best_device = device;
    }
  }
  return best_device;
}

std::string multicast_device(std::string_view group) {
  std::ifstream file("/proc/net/route");
  std::ostringstream text;
  text << file.rdbuf();
  return multicast_device(group, text.str());
}

}  // namespace dance
