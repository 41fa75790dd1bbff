// BenchTunnel: how long a pose takes from a guest to the server and on to another guest, and what
// the server pays for it; beside bare UDP and ENet relays, turn about in the same run.
//
// Two ways of dancing: everybody's pose at the same moment, which is what a relay must master and
// where a datagram holds most; and spread evenly over the frame, as people dance who did not start
// together.
//
// Units/frames: microseconds of this machine's clock. A delivery is one pose decoded by one other
//               guest of those who decode (bench/tunnel/crowd.h): `sent` counts those that were
//               due. Bytes are those of a second of dancing, with the headers of IP and UDP.
// Ownership:    owns the relays' processes, which end with it.
// Threads:      none inside; runs its poller in the caller's thread, where all guests live.
// Failure:      run_bench_tunnel() names the relay that could not start or stayed silent.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

struct BenchTunnelOptions {
  std::size_t guests = 30;
  double hz = 60.0;
  double seconds = 10.0;   // of each way
  double share_ms = -1.0;  // the server's window; < 0 = its own choice
  bool is_plain = false;   // the tunnel's codec is the plain one
  // So many guests speak too: the tunnel with that is measured beside the tunnel without, twice,
  // instead of the other relays.
  std::size_t voices = 0;
};

struct TunnelMeasure {
  std::uint64_t sent = 0;
  std::uint64_t delivered = 0;
  std::vector<Duration> took;       // sorted
  double server_cpu_percent = 0.0;  // of one core
  double down_bytes_per_s = 0.0;    // of one guest
  double payload_bytes = 0.0;       // of a pose
  // What all else costs: headers, seal, acknowledgements, pings.
  double overhead_up = 0.0;    // bytes for each pose that was sent
  double overhead_down = 0.0;  // bytes for each pose that was delivered
  // Of voices: of one guest who speaks, and who hears. Not in the figures above.
  std::vector<Duration> voice_took;  // sorted
  double voices_share = 0.0;         // of those that were due, delivered
  double voice_up_bytes_per_s = 0.0;
  double voice_down_bytes_per_s = 0.0;

  double percentile_us(double fraction) const;
  double voice_percentile_us(double fraction) const;
};

struct TunnelWay {
  std::string name;  // as in the JSON; "" for the tunnel itself
  std::string title;
  TunnelMeasure together, spread;
  double idle_cpu_percent = 0.0;  // while another way danced
};

// The tunnel first.
using TunnelWays = std::vector<TunnelWay>;

// `own_program` is this program's path: it serves as the other relays too.
Result<TunnelWays> run_bench_tunnel(const BenchTunnelOptions& options,
                                    const std::string& own_program);

std::string bench_tunnel_table(const BenchTunnelOptions& options, const TunnelWays& ways);
std::string bench_tunnel_json(const BenchTunnelOptions& options, const TunnelWays& ways);

}  // namespace dance
