// RouterPort: asks the home router to forward a UDP port to this computer and to report its
// internet address, so that guests from elsewhere reach a room here. The router forwards the port
// for an hour; the request is renewed after half of the granted time.
//
// Units/frames: MonoTime of this process.
// Ownership:    owns its socket.
// Threads:      one owner; nothing waits.
// Failure:      a router without this protocol does not answer: the state becomes kSilent.
//               Malformed answers are ignored.
// Source:       RFC 6886, NAT Port Mapping Protocol.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/net/udp_socket.h"

namespace dance {

class RouterPort {
 public:
  static constexpr std::uint16_t kProtocolPort = 5351;
  enum class State { kAsking, kOpen, kRefused, kSilent };

  // `router` includes the port that receives the requests.
  static Result<RouterPort> start(const Address& router, std::uint16_t port, MonoTime now);

  // Sends due requests and reads answers. True if state() changed.
  bool work(MonoTime now);
  // Releases the port without waiting for the router's answer.
  void close();

  State state() const { return state_; }
  // The address for invitations, with the outer port if it differs. Empty unless the port is open.
  std::string address() const;
  // The router's own address is a private one, so guests from the internet cannot reach it.
  bool is_behind_another() const;

 private:
  RouterPort(UdpSocket socket, std::uint16_t port) : socket_(std::move(socket)), port_(port) {}
  void ask(std::uint32_t lifetime_s);
  void take(std::span<const std::uint8_t> bytes, MonoTime now);

  UdpSocket socket_;
  std::uint16_t port_;
  State state_ = State::kAsking;
  std::string host_;  // "" until the router reports it
  std::uint16_t outer_port_ = 0;
  int tries_ = 0;
  MonoTime next_;  // when to ask again
};

}  // namespace dance
