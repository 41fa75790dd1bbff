#include "producers/receive/input_report.h"

namespace dance {
namespace {

bool is_any_ipv4(const Address& at) { return at.with_port(0) == Address::any_ipv4(0); }

}  // namespace

std::string nothing_arrives_text(const Address& at) {
  const std::string port = std::to_string(at.port());
  if (!at.is_loopback())
    return "let the program send to an address of this machine and port " + port +
           ", and let the firewall pass it";
  const bool is_ipv4 = at.family() == Address::Family::kIpv4;
  const std::string host = is_ipv4 ? "127.0.0.1" : "::1";
  return "let the program send to " + host + ", port " + port + " ('localhost' may be " +
         (is_ipv4 ? "::1" : "127.0.0.1") +
         "); a program of another machine is received at --listen 0.0.0.0:" + port;
}

InputReport::Fault InputReport::fault_of(const InputState& state,
                                         std::uint64_t arrived_elsewhere) const {
  if (state.arrived > arrived_) return Fault::kUnusable;
  return arrived_elsewhere > 0 ? Fault::kElsewhere : Fault::kNothing;
}

std::string InputReport::line_of(Fault fault, const PoseReceiver& receiver,
                                 const Address& elsewhere) const {
  const InputState state = receiver.state();
  const std::string where = state.at.is_set() ? " at " + state.at.to_string() : "";
  if (fault == Fault::kElsewhere) {
    const Address own = is_any_ipv4(state.at) ? Address::loopback(state.at.port()) : state.at;
    return name_ + ": nothing arrives" + where + ", but datagrams arrive at " +
           elsewhere.to_string() + ": let the program send to " + own.to_string() +
           ", or start with --listen " + elsewhere.to_string();
  }
  if (fault == Fault::kNothing)
    return name_ + ": nothing arrives" + where + ": " + receiver.diagnosis();
  return name_ + ": " + std::to_string(state.arrived - arrived_) + " datagrams" + where +
         (state.from.is_set() ? " from " + state.from.to_string() : "") +
         " make no pose: " + receiver.diagnosis();
}

std::vector<std::string> InputReport::tick(const PoseReceiver& receiver, const Address& elsewhere,
                                           std::uint64_t arrived_elsewhere, MonoTime now) {
  std::vector<std::string> lines;
  const InputState state = receiver.state();
  if (state.is_clock_unusable && !has_reported_clock_) {
    has_reported_clock_ = true;
    lines.push_back(name_ +
                    ": the sender's clock stands still or ticks coarsely: poses get their times "
                    "of arrival");
  }
  if (!since_.is_set()) since_ = now;
  if (state.poses > poses_) {
    if (reported_ != Fault::kNone) lines.push_back(name_ + ": poses arrive");
    reported_ = pending_ = Fault::kNone;
    poses_ = state.poses;
    arrived_ = state.arrived;
    since_ = now;
    return lines;
  }
  if (now - since_ < kTimeout) return lines;
  // The first fault is reported at once, a different one after it has lasted for kTimeout.
  const Fault found = fault_of(state, arrived_elsewhere);
  if (found != pending_) pending_since_ = now;
  pending_ = found;
  if (found == reported_ || (reported_ != Fault::kNone && now - pending_since_ < kTimeout))
    return lines;
  // The first line still holds when datagrams arrived earlier and no longer do.
  if (reported_ != Fault::kNone && found == Fault::kNothing) return lines;
  reported_ = found;
  lines.push_back(line_of(found, receiver, elsewhere));
  return lines;
}

}  // namespace dance
