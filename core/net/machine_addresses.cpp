#include "core/net/machine_addresses.h"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/net/udp_socket.h"

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

// Each device's addresses, those of IPv4 first.
template <class Each>
void for_each_address(Each each) {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return;
  for (const int family : {AF_INET, AF_INET6})
    for (const ifaddrs* it = all; it != nullptr; it = it->ifa_next) {
      if (it->ifa_addr == nullptr || it->ifa_addr->sa_family != family) continue;
      sockaddr_storage raw{};
      std::memcpy(&raw, it->ifa_addr,
                  family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6));
      each(*it, Address::from_sockaddr(raw));
    }
  freeifaddrs(all);
}

// The errno of connect() or bind() of a new UDP socket; 0 if it succeeds, or if there is no socket.
int errno_of(int (*call)(int, const sockaddr*, socklen_t), const Address& address) {
  const bool is_ipv4 = address.family() == Address::Family::kIpv4;
  const int fd = ::socket(is_ipv4 ? AF_INET : AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return 0;
  sockaddr_storage raw{};
  const socklen_t length = address.to_sockaddr(address.family(), raw);
  const int error = call(fd, reinterpret_cast<const sockaddr*>(&raw), length) != 0 ? errno : 0;
  ::close(fd);
  return error;
}

}  // namespace

std::vector<std::string> machine_addresses() {
  std::vector<std::string> found;
  for_each_address([&](const ifaddrs& it, const Address& address) {
    if (found.size() >= kMostAddresses) return;
    if ((it.ifa_flags & IFF_UP) == 0 || (it.ifa_flags & IFF_LOOPBACK) != 0) return;
    if (!address.is_set() || address.is_loopback() || is_link_local(address)) return;
    const std::string text = without_port(address);
    if (std::find(found.begin(), found.end(), text) == found.end()) found.push_back(text);
  });
  return found;
}

Address router_in(std::string_view route_table) {
  constexpr unsigned long kIsGateway = 0x2;
  std::istringstream lines{std::string(route_table)};
  std::string line;
  std::getline(lines, line);  // the heading
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string device, destination, router, flags;
    if (!(words >> device >> destination >> router >> flags) || router.size() != 8) continue;
    const bool is_default = destination == "00000000";
    if (!is_default || (std::strtoul(flags.c_str(), nullptr, 16) & kIsGateway) == 0) continue;
    // The table shows the address in memory as a number of this machine.
    const auto ip = static_cast<std::uint32_t>(std::strtoul(router.c_str(), nullptr, 16));
    std::array<std::uint8_t, sizeof ip> bytes{};
    std::memcpy(bytes.data(), &ip, sizeof ip);
    return Address::of(bytes, 0);
  }
  return {};
}

Address default_router() {
  std::ifstream file("/proc/net/route");
  std::ostringstream table;
  table << file.rdbuf();
  return router_in(table.str());
}

std::string device_of(const Address& address) {
  std::string device;
  for_each_address([&](const ifaddrs& it, const Address& found) {
    if (found.with_port(0) == address.with_port(0)) device = it.ifa_name;
  });
  return device;
}

std::string device_towards(const Address& host) {
  const auto socket = UdpSocket::connect(host, UdpRoom{1, 64});
  return socket ? device_of(socket->local_address()) : "";
}

bool is_route_forbidden(const Address& host) { return errno_of(::connect, host) == EACCES; }

bool is_udp_port_taken(std::uint16_t port) {
  return errno_of(::bind, Address::loopback(port)) == EADDRINUSE;
}

Loopback loopback_state() {
  Loopback state;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return state;
  for (const ifaddrs* it = all; it != nullptr; it = it->ifa_next)
    if ((it->ifa_flags & IFF_LOOPBACK) != 0) state.is_up = (it->ifa_flags & IFF_UP) != 0;
  freeifaddrs(all);
  state.has_address = !device_of(Address::loopback(0)).empty();
  return state;
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
