#include "tunnel/server/pace/share_plan.h"

#include <algorithm>

#include "core/net/datagram_sink.h"
#include "tunnel/wire/wire.h"

namespace dance {
namespace {

// Type, flags, number, and what comes along now and then.
constexpr double kRecordsHead_bytes = 8.0;
constexpr double kDatagram_bytes =
    static_cast<double>(kIpUdp_bytes + wire::kSealOverhead) + kRecordsHead_bytes;
// A base frame refers to older frames than others do.
constexpr double kBaseFrameCost = 1.4;
constexpr std::size_t kRampSteps = 3;  // a half, a quarter, an eighth

struct Flow {
  double poses_per_s = 0.0;
  double bytes_per_s = 0.0;
};

Flow sum_of(WantedFlows flows, std::size_t ramp) {
  Flow sum;
  for (std::size_t i = 0; i < flows.size(); ++i) {
    const WantedFlow& flow = flows[i];
    const std::uint8_t divider = std::max(flow.divider, ramp_divider(i, flows.size(), ramp));
    const double share = 1.0 / static_cast<double>(divider);
    sum.poses_per_s += flow.poses_per_s * share;
    sum.bytes_per_s += flow.bytes_per_s * share * (divider > 1 ? kBaseFrameCost : 1.0);
  }
  return sum;
}

// The first of a datagram waits for the window, and those that come meanwhile go along.
double cost_of(const Flow& flow, Duration window) {
  const double datagrams = flow.poses_per_s / (1.0 + flow.poses_per_s * window.as_seconds());
  return flow.bytes_per_s + datagrams * kDatagram_bytes;
}

}  // namespace

std::size_t longest_ramp(std::size_t guests) { return guests == 0 ? 0 : guests + kRampSteps - 1; }

std::uint8_t ramp_divider(std::size_t place, std::size_t guests, std::size_t ramp) {
  const std::size_t behind = guests - 1 - place;
  const std::size_t steps = ramp > behind ? std::min(ramp - behind, kRampSteps) : 0;
  return static_cast<std::uint8_t>(1u << steps);
}

double share_cost(WantedFlows flows, std::size_t ramp, Duration window) {
  return cost_of(sum_of(flows, ramp), window);
}

Duration share_window_for(WantedFlows flows, std::size_t ramp, double bytes_per_s) {
  const Flow flow = sum_of(flows, ramp);
  if (cost_of(flow, Duration()) <= bytes_per_s) return Duration();
  const double for_headers = bytes_per_s - flow.bytes_per_s;
  // poses · head / (1 + poses · window) = for_headers
  const double window_s =
      for_headers > 0.0 ? kDatagram_bytes / for_headers - 1.0 / flow.poses_per_s : 1.0;
  return Duration::seconds(std::min(window_s, 1.0));
}

std::size_t ramp_for(WantedFlows flows, double bytes_per_s) {
  std::size_t ramp = 0;
  while (ramp < longest_ramp(flows.size()) &&
         share_cost(flows, ramp, kLongestShareWindow) > bytes_per_s)
    ++ramp;
  return ramp;
}

Duration share_window_for_company(WantedFlows flows, std::size_t ramp, double poses_a_datagram) {
  const double poses_per_s = sum_of(flows, ramp).poses_per_s;
  if (poses_a_datagram <= 1.0 || poses_per_s <= 0.0) return Duration();
  return std::min(Duration::seconds((poses_a_datagram - 1.0) / poses_per_s), kLongestShareWindow);
}

}  // namespace dance
