#include "consumers/osc/osc_output.h"

#include "core/program/talk.h"

namespace dance {
namespace {

constexpr UdpRoom kOnePacket{1, OscBundleWriter::kMostPacketBytes};

}  // namespace

Result<OscOutput> OscOutput::open(const std::string& address, const std::string& usual) {
  DANCE_TRY(const Address to, Address::resolve(address.empty() ? usual : address));
  DANCE_TRY(UdpSocket socket, UdpSocket::connect(to, kOnePacket));
  return OscOutput(std::move(socket), to);
}

void OscOutput::report(const char* name) {
  if (!report_) report_.emplace(name);
  if (const auto line = report_->tick(socket_.counters(), to_)) talk::warn("{}", *line);
}

std::string OscOutput::summary() const {
  const UdpSocket::Counters& counters = socket_.counters();
  std::string line = "to " + to_.to_string() + ": " + std::to_string(counters.sent) + " packets, " +
                     std::to_string(counters.sent_bytes) + " bytes";
  if (counters.refused > 0)
    line += "; " + std::to_string(counters.refused) + " refused, as no program listens there";
  if (counters.send_failed > 0)
    line += "; " + std::to_string(counters.send_failed) + " could not be sent";
  return line;
}

}  // namespace dance
