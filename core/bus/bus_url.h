// The URL of a bus, in the form that LCM's programs take: udpm://GROUP:PORT?ttl=N&recv_buf_size=N.
//
// Failure: parse_udpm_url() names what is wrong and a URL that works.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

struct BusAddress {
  std::string group;     // e.g. 239.255.76.67
  std::uint32_t ip = 0;  // the group as a number: its first byte is the highest
  int port = 0;
  int ttl = 0;                   // 0: stays on this machine; 1 or more: open to the network
  int receive_buffer_bytes = 0;  // 0: not given
};

Result<BusAddress> parse_udpm_url(std::string_view url);

// "239.255.76.67" as a number whose highest byte is 239.
std::optional<std::uint32_t> parse_ipv4(std::string_view text);

}  // namespace dance
