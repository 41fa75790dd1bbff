#include "apps/doctor/doctor_cluster.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/net/secure_random.h"
#include "tunnel/nats/nats_bus.h"

namespace dance {
namespace {

using Grade = Finding::Grade;

constexpr Duration kListensToServers = Duration::ms(1500);
constexpr Duration kTurn = Duration::ms(5);
// More than this on every pose of another server's guests is felt before it is seen elsewhere.
constexpr Duration kLongWayToNats = Duration::ms(5);
constexpr Duration kClocksApart = Duration::ms(1);

std::string ms_text(Duration duration) { return fmt::format("{:.2f} ms", duration.as_ms()); }

Finding check_bucket(const NatsProbe::Bucket& bucket) {
  Finding finding{"bucket " + bucket.name, Grade::kOk, "", ""};
  const bool is_of_keys = bucket.name == kKeysBucket;
  if (bucket.cannot_read) {
    finding.grade = Grade::kProblem;
    finding.what = "cannot be read: " + bucket.cannot_read->what;
    finding.cure = "let this user use it, as examples/cluster/accounts.conf does";
  } else if (!bucket.is_there) {
    finding.grade = Grade::kNote;
    finding.what = "is not there yet; the first server makes it";
  } else if (bucket.cannot_write && !is_of_keys) {
    finding.grade = Grade::kProblem;
    finding.what = "cannot be written: " + bucket.cannot_write->what;
    finding.cure = "let this user publish to $KV." + bucket.name + ".>";
  } else if (bucket.cannot_write) {
    finding.what = "can be read, and not be written: this user makes and revokes no keys";
  } else {
    finding.what = "can be read and written";
  }
  return finding;
}

Finding check_replicas(const NatsProbe::Bucket& bucket, std::size_t named) {
  Finding finding{"copies " + bucket.name, Grade::kOk,
                  fmt::format("{} of {} NATS servers have each value", bucket.current_replicas,
                              bucket.replicas),
                  ""};
  if (bucket.current_replicas < bucket.replicas) {
    finding.grade = Grade::kNote;
    finding.what += ": one more that fails may be one too many";
    finding.cure = "systemctl status nats-server   (on each machine)";
  } else if (bucket.replicas < 3) {
    finding.grade = Grade::kNote;
    finding.what += ": with its disk they are lost, and while it is down nobody can come or leave";
    finding.cure = named >= 3
                       ? "nats stream edit KV_" + bucket.name + " --replicas 3   (the tool natscli)"
                       : "three NATS servers, and --cluster with all of their names";
  }
  return finding;
}

}  // namespace

std::vector<Finding> check_nats(const NatsProbe& found, const NatsOptions& options) {
  if (found.no_connection)
    return {{"NATS", Grade::kProblem, found.no_connection->what,
             "journalctl -u nats-server   (says on its side why)"}};
  std::vector<Finding> findings{
      {"NATS", Grade::kOk, found.server + " lets us in", ""},
      {"round trip", Grade::kOk, ms_text(found.round_trip) + " to NATS and back", ""}};
  if (found.round_trip > kLongWayToNats) {
    findings.back().grade = Grade::kNote;
    findings.back().what += ": poses between servers are late by as much";
    findings.back().cure = "name a NATS server in this machine's network first in --cluster";
  }
  if (found.no_jetstream) {
    findings.push_back({"JetStream", Grade::kProblem, "keeps nothing: " + found.no_jetstream->what,
                        "jetstream { store_dir: ... } in nats-server's configuration, and "
                        "jetstream: enabled in the account"});
    return findings;
  }
  findings.push_back({"JetStream", Grade::kOk, "is there", ""});
  for (const NatsProbe::Bucket& bucket : found.buckets) {
    findings.push_back(check_bucket(bucket));
    if (bucket.is_there && bucket.replicas > 0)
      findings.push_back(check_replicas(bucket, options.urls.size()));
  }
  return findings;
}

std::vector<Finding> check_servers(const std::map<ServerId, ClusterProbe::Seen>& seen) {
  if (seen.empty())
    return {
        {"servers", Grade::kNote, "none beats", "dance server --cluster ...   (on each machine)"}};
  std::vector<Finding> findings;
  const ClusterProbe::Seen* first = nullptr;
  const ClusterProbe::Seen* last = nullptr;
  for (const auto& [id, server] : seen) {
    Finding finding{fmt::format("server {:08x}", id >> 32), Grade::kOk, "", ""};
    const Address& address = server.beat.address;
    finding.what =
        fmt::format("{}{} links, {} guests", address.is_set() ? address.to_string() + ", " : "",
                    server.beat.links, server.beat.guests);
    if (server.answers == 0) {
      finding.grade = Grade::kProblem;
      finding.what += ", beats but tells no time";
      finding.cure = "let this user use dance.1.>";
    } else {
      finding.what += ", " + ms_text(server.round_trip) + " away";
      if (first == nullptr || server.offset < first->offset) first = &server;
      if (last == nullptr || server.offset > last->offset) last = &server;
    }
    findings.push_back(std::move(finding));
  }
  if (first == nullptr || seen.size() < 2) return findings;
  const Duration apart = last->offset - first->offset;
  const Duration unknown = (first->round_trip + last->round_trip) / 2;
  Finding clocks{
      "clocks", Grade::kOk,
      fmt::format("at most {} apart, as far as {} can tell", ms_text(apart), ms_text(unknown)), ""};
  if (apart > kClocksApart) {
    clocks.grade = Grade::kNote;
    clocks.what += ": music stands differently at their guests";
    clocks.cure = apart < kClocksApart + unknown
                      ? "dance doctor --cluster ...   (again, from nearer to NATS)"
                      : "dance status --cluster --once   (on each machine: its clock's round trip)";
  }
  findings.push_back(std::move(clocks));
  return findings;
}

std::vector<Finding> examine_cluster(const NatsOptions& options) {
  const NatsProbe found = probe_nats(options, {kClusterBucket, kKeysBucket});
  std::vector<Finding> findings = check_nats(found, options);
  const bool is_there = std::any_of(
      found.buckets.begin(), found.buckets.end(),
      [](const auto& bucket) { return bucket.name == kClusterBucket && bucket.is_there; });
  // No server has been there; and asking would make the bucket.
  if (!is_there) return findings;
  auto poller = Poller::create();
  if (!poller) return findings;
  const auto bus = NatsBus::connect(options, **poller);
  if (!bus) {
    findings.push_back({"servers", Grade::kProblem, bus.error().what, ""});
    return findings;
  }
  ClusterProbe probe(secure_random_u64() | 1, **bus);
  (*poller)->add_timer(mono_now(), [&](MonoTime now) { return probe.tick(now); });
  for (const MonoTime end = mono_now() + kListensToServers; mono_now() < end;)
    (*poller)->run_once(kTurn);
  for (Finding& finding : check_servers(probe.seen())) findings.push_back(std::move(finding));
  return findings;
}

}  // namespace dance
