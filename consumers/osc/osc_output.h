// OscOutput: sends packets of Open Sound Control to one address, each at once.
//
// Units/frames: none.
// Ownership:    owns its socket; never allocates after open().
// Threads:      none inside; one owner.
// Failure:      open() names an address that is none; what cannot be sent, or is refused as no
//               program listens there, is counted and lost, as newer packets follow.
#pragma once

#include <optional>
#include <string>

#include "consumers/osc/output_report.h"
#include "core/net/udp_socket.h"
#include "formats/osc/osc_bundle_writer.h"

namespace dance {

class OscOutput final : public OscPacketSink {
 public:
  // Without an address, `usual`.
  static Result<OscOutput> open(const std::string& address, const std::string& usual);

  void on_packet(std::span<const std::uint8_t> packet) override { socket_.send_now(to_, packet); }
  // Tells the user when no program receives there. `name`: of the protocol.
  void report(const char* name);
  // "to 127.0.0.1:39539: 40 packets, 48,000 bytes", and what went wrong.
  std::string summary() const;

 private:
  OscOutput(UdpSocket socket, const Address& to) : socket_(std::move(socket)), to_(to) {}

  UdpSocket socket_;
  Address to_;
  std::optional<OutputReport> report_;
};

}  // namespace dance
