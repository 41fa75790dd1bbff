// ServerCandidates limits which of the servers that its server lists a link probes, and where it
// connects. A lying server could aim its links at any host: it lists a thousand ports of a third
// host, or lists a victim and says goodbye. So the number of candidates is bounded for a time, a
// host has at most two ports, and each candidate is probed at most once in ten seconds. A link
// connects only to candidates that have answered a probe, and not too often. A public server
// cannot list hosts of the link's own network.
//
// Units/frames: MonoTime of the link's clock.
// Ownership:    plain values of fixed size.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/token_bucket.h"
#include "core/net/address.h"
#include "tunnel/wire/wire_servers.h"

namespace dance {

class ServerCandidates {
 public:
  // Different candidates within kWindow, whatever the lists name.
  static constexpr std::size_t kMost = wire::kMaxServers;
  static constexpr Duration kWindow = Duration::s(600);
  static constexpr Duration kProbeEach = Duration::s(10);
  static constexpr std::size_t kPortsPerHost = 2;
  // Connection attempts to one candidate. A candidate that welcomes the link gets the burst again.
  static constexpr double kTriesPerSecond = 0.1;
  static constexpr double kTryBurst = 3.0;

  enum class Verdict : std::uint8_t { kTaken, kNotReachable, kTooManyPorts, kTooMany, kCount };
  struct Counters {
    std::array<std::uint64_t, static_cast<std::size_t>(Verdict::kCount)> verdicts{};
    std::uint64_t of(Verdict verdict) const { return verdicts[static_cast<std::size_t>(verdict)]; }
  };

  // The candidates in the list that `server` sent, and the home server: the first server that sent
  // a list, whose address the user gave. Candidates stay known for kWindow after the list that
  // named them last, or after the last list that they sent.
  wire::ServerList accept(const Address& server, const wire::ServerList& named, MonoTime now);
  // Counts an answer to a probe.
  void note_answer(const Address& server);
  // The link has a session with this server.
  void note_welcome(const Address& server);
  // True for the home server, and for a known candidate that has answered a probe.
  bool has_answered(const Address& server) const;
  // Whether the link may connect to this server now, which counts as a try.
  bool take_try(const Address& server, MonoTime now);
  // Returns the time at which all these servers may be probed: now or later.
  MonoTime probe_due(std::span<const Address> servers, MonoTime now) const;
  // Counts these as probed.
  void note_probes(std::span<const Address> servers, MonoTime now);
  const Counters& counters() const { return counters_; }

 private:
  struct Candidate {
    Address server;
    MonoTime named;
    bool has_answered = false;
    TokenBucket tries{kTriesPerSecond, kTryBurst};
  };
  struct Probed {
    Address server;
    MonoTime at;
  };
  Verdict take(const Address& server, const Address& candidate, MonoTime now);

  Candidate* find(const Address& server);

  Address home_;
  FixedList<Candidate, kMost> known_;
  // Candidates, and servers that the link was connected to.
  FixedList<Probed, 2 * kMost> probed_;
  Counters counters_;
};

}  // namespace dance
