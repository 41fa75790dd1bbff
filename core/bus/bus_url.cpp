#include "core/bus/bus_url.h"

#include <algorithm>
#include <charconv>

#include "core/base/printable.h"

namespace dance {
namespace {

constexpr int kMaxTtl = 255;
constexpr int kMaxReceiveBuffer_bytes = 1 << 30;

std::optional<int> parse_number(std::string_view text, int least, int most) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > most)
    return std::nullopt;
  return value;
}

// Applies one "name=value" of the URL; "" or what is wrong with it.
std::string apply_option(std::string_view option, BusAddress& address) {
  const std::size_t equals = option.find('=');
  const std::string_view name = option.substr(0, equals);
  const std::string_view text =
      equals == std::string_view::npos ? std::string_view() : option.substr(equals + 1);
  if (name == "ttl") {
    const auto ttl = parse_number(text, 0, kMaxTtl);
    if (!ttl) return "ttl is not a number from 0 to 255";
    address.ttl = *ttl;
  } else if (name == "recv_buf_size") {
    const auto bytes = parse_number(text, 1, kMaxReceiveBuffer_bytes);
    if (!bytes) return "recv_buf_size is not a number of bytes from 1 to 1073741824";
    address.receive_buffer_bytes = *bytes;
  } else if (name != "transmit_only") {  // LCM accepts it still, and ignores it
    return "unknown option '" + printable(name) + "'; ttl and recv_buf_size are known";
  }
  return "";
}

}  // namespace

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

Result<BusAddress> parse_udpm_url(std::string_view url) {
  constexpr std::string_view kScheme = "udpm://";
  const auto wrong = [&](const std::string& why) {
    return fail("bus URL '" + printable(url) + "': " + why +
                "; write it like udpm://239.255.76.67:7667?ttl=0");
  };
  if (!url.starts_with(kScheme)) return wrong("only udpm:// is supported");
  const std::string_view rest = url.substr(kScheme.size());
  const std::size_t question = rest.find('?');
  const std::string_view place = rest.substr(0, question);
  const std::size_t colon = place.find(':');
  if (colon == std::string_view::npos) return wrong("there is no port");
  BusAddress address;
  address.group = place.substr(0, colon);
  const auto ip = parse_ipv4(address.group);
  if (!ip || (*ip >> 28) != 14) return wrong("the group is not in 224.0.0.0/4");
  address.ip = *ip;
  const auto port = parse_number(place.substr(colon + 1), 1, 65535);
  if (!port) return wrong("the port is not a number from 1 to 65535");
  address.port = *port;
  if (question == std::string_view::npos) return address;
  std::string_view options = rest.substr(question + 1);
  while (!options.empty()) {
    const std::size_t end = std::min(options.find('&'), options.size());
    const std::string_view option = options.substr(0, end);
    options.remove_prefix(std::min(end + 1, options.size()));
    if (option.empty()) continue;
    if (const std::string why = apply_option(option, address); !why.empty()) return wrong(why);
  }
  return address;
}

}  // namespace dance
