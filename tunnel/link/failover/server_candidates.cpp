#include "tunnel/link/failover/server_candidates.h"

#include <algorithm>

namespace dance {

ServerCandidates::Candidate* ServerCandidates::find(const Address& server) {
  const auto found = std::ranges::find(known_, server, &Candidate::server);
  return found == known_.end() ? nullptr : &*found;
}

ServerCandidates::Verdict ServerCandidates::take(const Address& server, const Address& candidate,
                                                 MonoTime now) {
  // A server may list only addresses that are no nearer than its own: a public one lists public
  // addresses.
  if (candidate.scope() == Address::Scope::kNone || candidate.scope() < server.scope())
    return Verdict::kNotReachable;
  if (Candidate* same = find(candidate)) {
    same->named = now;
    return Verdict::kTaken;
  }
  const auto ports = std::ranges::count_if(known_, [&](const Candidate& known) {
    return known.server.with_port(0) == candidate.with_port(0);
  });
  // A machine may hold a whole cluster of its own, as in tests.
  if (static_cast<std::size_t>(ports) >= kPortsPerHost &&
      candidate.scope() != Address::Scope::kMachine)
    return Verdict::kTooManyPorts;
  return known_.try_push({.server = candidate, .named = now}) ? Verdict::kTaken : Verdict::kTooMany;
}

wire::ServerList ServerCandidates::accept(const Address& server, const wire::ServerList& named,
                                          MonoTime now) {
  if (!home_.is_set()) home_ = server;
  // A server does not list itself.
  if (Candidate* current = find(server)) current->named = now;
  for (std::size_t i = known_.size(); i-- > 0;)
    if (now - known_[i].named > kWindow) known_.erase_at(i);
  // The home server comes first: no list can keep it out.
  wire::ServerList taken;
  if (server != home_) (void)taken.try_push(home_);
  for (const Address& candidate : named) {
    if (candidate == home_) continue;
    const Verdict verdict = take(server, candidate, now);
    ++counters_.verdicts[static_cast<std::size_t>(verdict)];
    if (verdict == Verdict::kTaken) (void)taken.try_push(candidate);
  }
  return taken;
}

void ServerCandidates::note_answer(const Address& server) {
  if (Candidate* candidate = find(server)) candidate->has_answered = true;
}

void ServerCandidates::note_welcome(const Address& server) {
  if (Candidate* candidate = find(server)) candidate->tries = {kTriesPerSecond, kTryBurst};
}

bool ServerCandidates::has_answered(const Address& server) const {
  return server == home_ || std::ranges::any_of(known_, [&](const Candidate& candidate) {
           return candidate.server == server && candidate.has_answered;
         });
}

bool ServerCandidates::take_try(const Address& server, MonoTime now) {
  if (server == home_) return true;
  Candidate* candidate = find(server);
  return candidate != nullptr && candidate->has_answered && candidate->tries.take(1.0, now);
}

MonoTime ServerCandidates::probe_due(std::span<const Address> servers, MonoTime now) const {
  MonoTime due = now;
  for (const Probed& probed : probed_)
    if (std::ranges::find(servers, probed.server) != servers.end())
      due = std::max(due, probed.at + kProbeEach);
  return due;
}

void ServerCandidates::note_probes(std::span<const Address> servers, MonoTime now) {
  for (std::size_t i = probed_.size(); i-- > 0;)
    if (now - probed_[i].at >= kProbeEach) probed_.erase_at(i);
  for (const Address& server : servers) (void)probed_.try_push({server, now});
}

}  // namespace dance
