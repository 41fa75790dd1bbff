#include "apps/doctor/doctor_network.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "apps/status/status_source.h"
#include "core/base/printable.h"
#include "core/net/local_address.h"
#include "house/session.h"
#include "producers/rokoko/rokoko_receiver.h"
#include "producers/vmc/vmc_receiver.h"

namespace dance {
namespace {

namespace fs = std::filesystem;
using Grade = Finding::Grade;

constexpr Duration kLookupTimeout = Duration::s(4);
constexpr Duration kSlowLookup = Duration::s(1);
constexpr int kTunnelType = 65534;  // ARPHRD_NONE: a device without a link layer

// Addresses for documentation (RFC 5737, RFC 3849): no host has them, and packets to them take the
// default route.
constexpr const char* kSomeIpv4Host = "198.51.100.1:9";
constexpr const char* kSomeIpv6Host = "[2001:db8::1]:9";

bool has_nameserver_line() {
  std::ifstream file("/etc/resolv.conf");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("nameserver")) return true;
  return false;
}

// The server in the session file that the window keeps; "" without one.
std::string server_of_user() {
  std::string folder;
  const char* config = std::getenv("XDG_CONFIG_HOME");  // NOLINT(concurrency-mt-unsafe)
  const char* home = std::getenv("HOME");               // NOLINT(concurrency-mt-unsafe)
  if (config != nullptr && *config == '/')
    folder = config;
  else if (home != nullptr && *home == '/')
    folder = std::string(home) + "/.config";
  if (folder.empty()) return "";
  const auto session = load_session(folder + "/dancegraph/house.toml");
  return session ? session->server : "";
}

// The ports of servers whose sockets this user can see.
std::vector<std::uint16_t> server_ports() {
  constexpr std::string_view kBegin = "server-", kEnd = ".sock";
  constexpr std::size_t kMost = 16;
  std::vector<std::uint16_t> ports;
  for (const std::string& folder :
       {local_socket_folder(), std::string("/run/dance-server/dance")}) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      const std::string name = entry->path().filename();
      if (!name.starts_with(kBegin) || !name.ends_with(kEnd) || ports.size() == kMost) continue;
      std::uint16_t port = 0;
      const char* last = name.data() + name.size() - kEnd.size();
      const auto read = std::from_chars(name.data() + kBegin.size(), last, port);
      if (read.ec == std::errc() && read.ptr == last) ports.push_back(port);
    }
  }
  return ports;
}

}  // namespace

Finding check_loopback(const Loopback& loopback) {
  Finding finding{"loopback", Grade::kOk, "127.0.0.1 is up", ""};
  if (loopback.is_up && loopback.has_address) return finding;
  finding.grade = Grade::kProblem;
  finding.what = loopback.is_up
                     ? "the loopback device lacks 127.0.0.1: programs of a house meet there"
                     : "the loopback device is down: programs of a house meet there";
  finding.cure = loopback.is_up ? "ip address add 127.0.0.1/8 dev lo" : "ip link set lo up";
  return finding;
}

bool is_vpn_device(const std::string& device, const std::string& devices) {
  if (device.empty()) return false;
  const std::string folder = devices + "/" + device;
  std::error_code error;
  if (fs::exists(folder + "/tun_flags", error)) return true;
  int type = 0;
  std::ifstream(folder + "/type") >> type;
  return type == kTunnelType;
}

Finding check_internet_route(const std::string& device, bool is_vpn) {
  Finding finding{"internet", Grade::kOk, "over " + printable(device), ""};
  if (device.empty()) {
    finding.grade = Grade::kNote;
    finding.what = "no route: dances on this machine and in its network need none";
    finding.cure = "ip route   (is there a line that begins with default?)";
  } else if (is_vpn) {
    finding.grade = Grade::kNote;
    finding.what += ", a VPN: poses and voices take its detour, and are late by as much";
    finding.cure = "nmcli connection down " + printable(device) + "   (or wg-quick down " +
                   printable(device) + "; or exclude the server's address in the VPN's settings)";
  }
  return finding;
}

Finding check_forbidden_route() {
  return {"internet", Grade::kNote,
          "a route forbids it, as the kill switch of a VPN does: servers elsewhere cannot be "
          "joined; dances on this machine go on",
          "ip route   (the line begins with prohibit: connect the VPN, or end its kill switch)"};
}

Finding check_ipv6_loopback(bool has_address) {
  if (has_address) return {"loopback, IPv6", Grade::kOk, "::1 is there", ""};
  return {"loopback, IPv6", Grade::kNote,
          "::1 is missing: nothing can listen at [::1], and what is sent there is lost",
          "sysctl -w net.ipv6.conf.lo.disable_ipv6=0   (or write 127.0.0.1 for ::1 and localhost)"};
}

std::vector<InputPort> usual_input_ports() {
  std::vector<InputPort> ports;
  for (const auto& [protocol, address] : {std::pair{"vmc", VmcReceiver::kUsualAddress},
                                          std::pair{"rokoko", RokokoReceiver::kUsualAddress}})
    ports.push_back({protocol, Address::resolve(address)->port()});
  return ports;
}

Finding check_input_ports(const std::vector<InputPort>& taken) {
  if (taken.empty()) return {"inputs", Grade::kOk, "the ports of dance receive are free", ""};
  Finding finding{"inputs", Grade::kNote, "", "ss -ulpn 'sport = :"};
  for (const InputPort& each : taken)
    finding.what += (finding.what.empty() ? "" : ", ") + std::string("port ") +
                    std::to_string(each.port) + " of " + each.protocol;
  finding.what +=
      ": taken. Unless this is a dance receive, another program gets what is sent there";
  finding.cure +=
      std::to_string(taken.front().port) +
      "'   (names the program: end it, or use dance receive --listen with another port)";
  return finding;
}

std::string host_name_of(const std::string& server) {
  if (server.starts_with('[')) return "";
  const std::string host = server.substr(0, server.rfind(':'));
  if (host.find(':') != std::string::npos) return "";
  const bool is_address = host.find_first_not_of("0123456789.") == std::string::npos;
  return is_address ? "" : host;
}

Finding check_names(const ResolverAnswer& lookup, bool has_nameserver) {
  using Outcome = ResolverAnswer::Outcome;
  const std::string name = "'" + printable(lookup.name) + "'";
  const bool is_real = lookup.name != kNoSuchName;
  const std::string took = std::to_string(lookup.took.count_ms()) + " ms";
  Finding finding{"names", Grade::kNote, "", ""};
  switch (lookup.outcome) {
    case Outcome::kFound:
      finding.what = "the server's name " + name + " is found in " + took;
      finding.grade = Grade::kOk;
      break;
    case Outcome::kUnknown:
      finding.what = is_real ? "no nameserver has the server's name " + name
                             : "the nameserver answers in " + took;
      if (!is_real) finding.grade = Grade::kOk;
      if (is_real)
        finding.cure = "getent hosts " + printable(lookup.name) + "   (is it spelt right?)";
      break;
    case Outcome::kNoAnswer:
      finding.what = has_nameserver
                         ? "no nameserver can be reached (" + printable(lookup.reason) +
                               "): servers can be joined by address only"
                         : "/etc/resolv.conf names no nameserver: servers can be joined by address "
                           "only";
      finding.cure = "resolvectl status   (or cat /etc/resolv.conf)";
      break;
    case Outcome::kSilent:
      finding.what = "the nameserver does not answer within " + took +
                     ": joining a server by its name fails after that time";
      finding.cure = "resolvectl status   (or cat /etc/resolv.conf)";
      break;
  }
  if (finding.grade == Grade::kOk && lookup.took > kSlowLookup) {
    finding.grade = Grade::kNote;
    finding.what += ", which is long: joining by name waits for it";
    finding.cure = "resolvectl status   (a nameserver in the list does not answer)";
  }
  return finding;
}

Finding check_server_reach(const std::string& address, const std::vector<std::string>& machine) {
  Finding finding{"server", Grade::kOk, "listens at " + printable(address), ""};
  // Addresses of the machine have no brackets and no port.
  const auto ipv6 = std::find_if(machine.begin(), machine.end(), [](const std::string& each) {
    return each.find(':') != std::string::npos;
  });
  const bool is_ipv4_alone = address.starts_with("0.0.0.0:");
  if (!is_ipv4_alone || ipv6 == machine.end()) return finding;
  finding.grade = Grade::kNote;
  finding.what += ", IPv4 alone, and this machine has IPv6 too (" + *ipv6 +
                  "): houses that have only IPv6 cannot connect";
  finding.cure = "dance server --bind ::   (accepts IPv4 too)";
  return finding;
}

std::vector<Finding> examine_network() {
  std::vector<Finding> findings{check_loopback(loopback_state())};
  findings.push_back(check_ipv6_loopback(!device_of(*Address::resolve("[::1]:1")).empty()));
  std::vector<InputPort> taken = usual_input_ports();
  std::erase_if(taken, [](const InputPort& it) { return !is_udp_port_taken(it.port); });
  findings.push_back(check_input_ports(taken));
  std::string device;
  for (const char* host : {kSomeIpv4Host, kSomeIpv6Host})
    if (device.empty()) device = device_towards(*Address::resolve(host));
  findings.push_back(device.empty() && is_route_forbidden(*Address::resolve(kSomeIpv4Host))
                         ? check_forbidden_route()
                         : check_internet_route(device, is_vpn_device(device)));
  const std::string server = host_name_of(server_of_user());
  findings.push_back(check_names(
      look_up_name(server.empty() ? kNoSuchName : server, kLookupTimeout), has_nameserver_line()));
  for (const std::uint16_t port : server_ports()) {
    const auto status = ask_server(port);
    if (!status || !status->contains("address") || !(*status)["address"].is_string()) continue;
    findings.push_back(
        check_server_reach((*status)["address"].get<std::string>(), machine_addresses()));
  }
  return findings;
}

}  // namespace dance
