#include "core/bus/multicast_route.h"

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>

namespace dance {
namespace {

std::optional<std::uint32_t> parse_ipv4(std::string_view text) {
  std::uint32_t address = 0;
  for (int i = 0; i < 4; ++i) {
    unsigned part = 256;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), part);
    if (error != std::errc() || part > 255) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (i < 3) {
      if (text.empty() || text.front() != '.') return std::nullopt;
      text.remove_prefix(1);
    }
    address = (address << 8) | part;
  }
  return text.empty() ? std::optional(address) : std::nullopt;
}

}  // namespace

Result<BusAddress> parse_udpm_url(std::string_view url) {
  constexpr std::string_view kScheme = "udpm://";
  const auto wrong = [&](const std::string& why) {
    return fail("bus URL '" + std::string(url) + "': " + why +
                "; write it like udpm://239.255.76.67:7667?ttl=0");
  };
  if (!url.starts_with(kScheme)) return wrong("only udpm:// is supported");
  std::string_view rest = url.substr(kScheme.size());
  rest = rest.substr(0, rest.find('?'));
  const std::size_t colon = rest.find(':');
  if (colon == std::string_view::npos) return wrong("there is no port");
  BusAddress address;
  address.group = rest.substr(0, colon);
  const auto ip = parse_ipv4(address.group);
  if (!ip || (*ip >> 28) != 14) return wrong("the group is not in 224.0.0.0/4");
  const std::string_view port = rest.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (error != std::errc() || end != port.data() + port.size() || address.port < 1 ||
      address.port > 65535)
    return wrong("the port is not a number from 1 to 65535");
  return address;
}

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
