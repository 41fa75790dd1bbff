#include "core/net/machine_addresses.h"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstring>

#include "core/net/address.h"

namespace dance {
namespace {

constexpr std::size_t kMostAddresses = 16;

bool is_link_local(const Address& address) {
  const auto& ip = address.ip();
  if (address.family() == Address::Family::kIpv4) return ip[0] == 169 && ip[1] == 254;
  return ip[0] == 0xfe && (ip[1] & 0xc0) == 0x80;
}

std::string without_port(const Address& address) {
  const std::string text = address.with_port(1).to_string();  // "1.2.3.4:1", "[::1]:1"
  const std::string host = text.substr(0, text.rfind(':'));
  return host.starts_with('[') ? host.substr(1, host.size() - 2) : host;
}

}  // namespace

std::vector<std::string> machine_addresses() {
  std::vector<std::string> found;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return found;
  for (const int family : {AF_INET, AF_INET6})
    for (const ifaddrs* it = all; it != nullptr && found.size() < kMostAddresses;
         it = it->ifa_next) {
      if (it->ifa_addr == nullptr || it->ifa_addr->sa_family != family) continue;
      if ((it->ifa_flags & IFF_UP) == 0 || (it->ifa_flags & IFF_LOOPBACK) != 0) continue;
      sockaddr_storage raw{};
      std::memcpy(&raw, it->ifa_addr,
                  family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6));
      const Address address = Address::from_sockaddr(raw);
      if (!address.is_set() || address.is_loopback() || is_link_local(address)) continue;
      const std::string text = without_port(address);
      if (std::find(found.begin(), found.end(), text) == found.end()) found.push_back(text);
    }
  freeifaddrs(all);
  return found;
}

bool is_private_address(const std::string& text) {
  const bool is_ipv6 = text.find(':') != std::string::npos;
  const auto address = Address::resolve(is_ipv6 ? "[" + text + "]:1" : text + ":1");
  if (!address || !address->is_set()) return false;
  if (address->is_loopback() || is_link_local(*address)) return true;
  const auto& ip = address->ip();
  if (address->family() == Address::Family::kIpv6) return (ip[0] & 0xfe) == 0xfc;
  return ip[0] == 10 || (ip[0] == 172 && (ip[1] & 0xf0) == 16) || (ip[0] == 192 && ip[1] == 168) ||
         (ip[0] == 100 && (ip[1] & 0xc0) == 64);
}

}  // namespace dance
