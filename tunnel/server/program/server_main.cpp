// dance server: where the houses' links meet.

#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "tunnel/server/program/audit_keeper.h"
#include "tunnel/server/program/cluster/cluster_membership.h"
#include "tunnel/server/program/invited_guests.h"
#include "tunnel/server/program/key_command.h"
#include "tunnel/server/program/server_keys.h"
#include "tunnel/server/program/server_watch.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance server                                  for houses on this machine, on port 7400
  dance server --invite alice --address dance.example.org
                                                prints an invitation, for Alice to open
  dance server --invite alice --room salsa --for 7d --qr
                                                into one room, good for a week, as a QR code too
  dance server --new-guest alice --address dance.example.org
                                                prints Alice's key, for her to paste into dance key
  dance server --new-guest alice --public-key A7…
                                                lets Alice's house in by the key that its
                                                dance key --public prints, without any secret
  dance server --new-guest alice --key-for 30d  a key that expires
  dance server --bind ::                        for houses elsewhere: those who have a key
  dance server --metrics 127.0.0.1:9464         a page for Prometheus at /metrics
  dance server --cluster nats://a:4222,nats://b:4222,nats://c:4222
                                                shares its rooms with other servers
  dance server --json > summary.json            what it did, when it is ended with Ctrl-C
While it runs, `dance status` on the same machine shows its rooms and guests, and `dance status
--log` who joined, who was refused and who was removed.
)";

constexpr Duration kSecond = Duration::s(1);
constexpr int kSecondsPerStatus = 10;
// Other servers whose guests share rooms with links of this one, counted once for each room.
constexpr std::size_t kRemoteServers = 256;

struct ServerProgramOptions {
  std::string bind = "127.0.0.1";
  std::uint16_t port = kDefaultServerPort;
  ServerLimits limits;
  std::size_t avatar_memory_mb = ServerLimits().file_bytes >> 20;
  std::string key_file;
  KeyCommand keys;
  SealCertificates certificates;
  double share_ms = -1.0;  // < 0: by the room
  std::string metrics;
  ClusterOptions cluster;
  bool json = false;
};

nlohmann::ordered_json summary(const Server& server, Duration uptime) {
  const ServerCounters& c = server.core().counters();
  const UdpSocket::Counters& socket = server.socket_counters();
  nlohmann::ordered_json rejected = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < kServerRejects; ++i)
    rejected[std::string(kServerRejectNames[i])] = c.rejected[i];
  const SealCounters& door = server.door().counters();
  nlohmann::ordered_json kept_out = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < kSealRejects; ++i)
    kept_out[std::string(kSealRejectNames[i])] = door.rejected[i];
  return {{"seconds", uptime.as_seconds()},
          {"datagrams_in", c.datagrams_in},
          {"datagrams_out", c.datagrams_out},
          {"bytes_in", c.bytes_in},
          {"bytes_out", c.bytes_out},
          {"records_in", c.records_in},
          {"records_out", c.records_out},
          {"records_repeated", c.records_repeated},
          {"voices_in", c.voices_in},
          {"voices_out", c.voices_out},
          {"voices_crowded", c.voices_crowded},
          {"voices_held_back", c.voices_held_back},
          {"voice_bytes_out", c.voice_bytes_out},
          {"states_in", c.states_in},
          {"states_out", c.states_out},
          {"file_chunks_in", c.file_chunks_in},
          {"file_chunks_out", c.file_chunks_out},
          {"file_refusals", c.file_refusals},
          {"datagrams_acked", c.datagrams_acked},
          {"key_frames_wanted", c.intra_frames_wanted},
          {"key_frames_asked", c.intra_frames_asked},
          {"sessions_begun", c.sessions_begun},
          {"sessions_resumed", c.sessions_resumed},
          {"sessions_timed_out", c.sessions_timed_out},
          {"sessions_removed", c.sessions_removed},
          {"goodbyes", c.goodbyes},
          {"send_failed", socket.send_failed},
          {"truncated", socket.truncated},
          {"rejected", rejected},
          {"handshakes", door.handshakes_done},
          {"moves", door.moves},
          {"rekeyings", door.rekeyings},
          {"kept_out", kept_out}};
}

// What was refused: each cause at once, and while it goes on, how often since, each minute.
template <std::size_t kCauses>
class RejectLog {
 public:
  using Counts = std::array<std::uint64_t, kCauses>;

  template <class Names>
  void tell(const Counts& rejected, const Names& names, const char* what, MonoTime now) {
    for (std::size_t i = 0; i < kCauses; ++i) {
      const bool was_said_lately = said_at_[i].is_set() && now - said_at_[i] < kAgain;
      if (rejected[i] == said_[i] || was_said_lately) continue;
      talk::warn("{} {}: {}", rejected[i] - said_[i], what, names[i]);
      said_[i] = rejected[i];
      said_at_[i] = now;
    }
  }

 private:
  static constexpr Duration kAgain = Duration::s(60);
  Counts said_{};
  std::array<MonoTime, kCauses> said_at_{};
};

void log_status(const Server& server, const ServerCounters& before) {
  const ServerCore& core = server.core();
  const ServerCounters& c = core.counters();
  talk::info(
      "{} rooms, {} links, {} guests, {} listeners; in the last {} s {} records in, {} out, {} kB "
      "out",
      core.room_count(), core.session_count(), core.guest_count(), core.listener_count(),
      kSecondsPerStatus, c.records_in - before.records_in, c.records_out - before.records_out,
      (c.bytes_out - before.bytes_out) / 1000);
}

Result<std::optional<SealCertificates>> certificates_of(const ServerProgramOptions& options) {
  const SealCertificates& given = options.certificates;
  if (given.chain.empty() && given.private_key.empty() && given.authorities.empty())
    return std::optional<SealCertificates>();
  if (given.chain.empty() || given.private_key.empty() || given.authorities.empty())
    return fail(
        "--certificate, --private-key and --authorities belong together: the server's own, "
        "and whose it trusts");
  return std::optional(given);
}

std::vector<NamedCount> handshakes_of(const SealCounters& door) {
  std::vector<NamedCount> counts{
      {"done", door.handshakes_done}, {"moved", door.moves}, {"rekeyed", door.rekeyings}};
  for (std::size_t i = 0; i < kSealRejects; ++i)
    counts.push_back({std::string(kSealRejectNames[i]), door.rejected[i]});
  return counts;
}

// In the cluster's bucket where a cluster is named, or else in this server's file.
Result<void> change_keys(const ServerProgramOptions& options, const ServerKeys& keys) {
  KeyCommand command = options.keys;
  command.port = options.port;
  if (options.cluster.urls.empty()) return run_key_command(command, *file_key_store(keys.path()));
  if (!command.invite.empty()) return fail(no_invitations_line(command.invite));
  DANCE_TRY(const NatsOptions nats, nats_options_of(options.cluster));
  DANCE_TRY(const auto store, cluster_key_store(nats, keys.identity().public_key()));
  return run_key_command(command, *store);
}

// The keys of the file and of the cluster.
void unite_keys(ServerKeys& keys, const ClusterKeys& cluster) {
  keys.set_cluster(cluster.entries());
  if (keys.in_both() > 0)
    talk::warn("{} names have a key in {} and another in the cluster: the cluster's counts",
               keys.in_both(), keys.path());
  if (keys.left_out() > 0)
    talk::warn("{} keys are more than a server takes, and open nothing", keys.left_out());
}

Result<void> run_server(const ServerProgramOptions& options) {
  DANCE_TRY(ServerKeys keys, ServerKeys::open(options.key_file));
  if (options.keys.is_given()) return change_keys(options, keys);
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(Address local, Address::resolve(options.bind, options.port));
  if (local.family() == Address::Family::kIpv6 && !machine_has_ipv6() && options.bind == "::") {
    talk::warn("this machine has no IPv6: the server listens on IPv4 alone");
    local = Address::any_ipv4(options.port);
  }
  ServerOptions of;
  of.limits = options.limits;
  of.limits.file_bytes = options.avatar_memory_mb << 20;
  if (options.share_ms >= 0.0) of.limits.share_window = Duration::seconds(options.share_ms * 1e-3);
  DANCE_TRY(of.certificates, certificates_of(options));
  std::unique_ptr<ClusterMembership> cluster;
  std::string cluster_urls;
  if (!options.cluster.urls.empty()) {
    std::signal(SIGPIPE, SIG_IGN);  // OpenSSL writes to sockets that their other end has closed
    ClusterOptions joins = options.cluster;
    joins.port = options.port;
    joins.nats.name = "dance server " + std::to_string(options.port);
    DANCE_TRY(cluster, ClusterMembership::join(joins, *poller));
    DANCE_TRY(const NatsOptions nats, nats_options_of(options.cluster));
    cluster_urls = shown_urls(nats);
    of.cluster = &cluster->node();
    of.limits.remote_servers = kRemoteServers;
    if (const auto other = cluster->keys().other_identity(keys.identity().public_key()))
      return fail(*other);
    unite_keys(keys, cluster->keys());
  }
  of.identity = keys.identity();
  of.keys = keys.ring();
  std::unique_ptr<InvitedGuests> invited;
  if (!cluster) {
    DANCE_TRY(WakeEvent wake, WakeEvent::create());
    invited = std::make_unique<InvitedGuests>(keys, std::move(wake), *poller);
    of.on_binding = [&](PeerId peer, const KeyEntry& entry, const PublicKey& house) {
      invited->on_binding(peer, entry, house);
    };
  }
  std::unique_ptr<AuditKeeper> audit;
  of.on_audit = [&audit](const Address& from, const AuditEvent& event) {
    if (audit) audit->add(from, event);
  };
  DANCE_TRY(auto server, Server::open(local, of, *poller));
  if (invited) invited->set_server(*server);
  if (cluster) {
    cluster->set_after_batch([&](MonoTime now) { server->end_cluster_turn(now); });
    cluster->set_on_keys([&] {
      unite_keys(keys, cluster->keys());
      if (const auto other = cluster->keys().other_identity(keys.identity().public_key()))
        talk::warn("{}, and start it again", *other);
      server->set_keys(keys.ring());
      talk::info("{} keys now", keys.guest_count());
    });
  }
  local = server->local_address();
  audit =
      std::make_unique<AuditKeeper>(audit_file(keys.path(), local.port()), local.port(), *poller);
  ServerWatch::Options shown;
  shown.address = local;
  shown.limits = of.limits;
  shown.metrics = options.metrics;
  shown.peer_text = [&](const ServerSession& session) {
    return server->door().address_of(session.peer).to_string() + " " +
           std::string(session.access.name.view());
  };
  shown.to_session = [&](MonoTime now) { return server->to_session(now); };
  shown.handshakes = [&] { return handshakes_of(server->door().counters()); };
  if (cluster)
    shown.cluster = [&](MonoTime now) {
      ClusterStatus status = cluster_status_of(cluster->node(), server->core(), now);
      status.nats = cluster->bus_counters();
      status.nats_keys = cluster->key_bus_counters();
      status.keys = cluster->keys().entries().size();
      return status;
    };
  DANCE_TRY(auto watch, ServerWatch::open(server->core(), shown, *poller));
  talk::info("hears on {}; Ctrl-C ends it", local.to_string());
  if (cluster)
    talk::info("in a cluster with {} other servers, through {}",
               cluster->node().peers().all().size(), cluster_urls);
  if (!local.is_loopback() && keys.guest_count() == 0 && !of.certificates)
    talk::warn("nobody elsewhere is invited or has a key yet: dance server --invite NAME does it");

  const MonoTime begin = mono_now();
  ServerCounters last_second, last_status;
  RejectLog<kServerRejects> dropped;
  RejectLog<kSealRejects> kept_out;
  int seconds = 0;
  poller->add_timer(begin + kSecond, [&](MonoTime now) {
    read_keys_again(keys, *server);
    if (cluster) cluster->tell();
    last_second = server->core().counters();
    auto rejected = last_second.rejected;
    // What comes twice is meant to, where a way loses some.
    rejected[static_cast<std::size_t>(ServerReject::kDuplicate)] = 0;
    dropped.tell(rejected, kServerRejectNames, "dropped", now);
    kept_out.tell(server->door().counters().rejected, kSealRejectNames, "kept out", now);
    if (++seconds % kSecondsPerStatus == 0) {
      if (last_second.datagrams_in != last_status.datagrams_in) log_status(*server, last_status);
      last_status = last_second;
    }
    return now + kSecond;
  });
  poller->run();

  watch->say_stopping();
  server->send_goodbye();
  if (cluster) cluster->flush();
  const auto report = summary(*server, mono_now() - begin);
  if (options.json)
    std::printf("%s\n", report.dump().c_str());
  else
    talk::info("{} records in, {} out, {} datagrams dropped", server->core().counters().records_in,
               server->core().counters().records_out, server->core().counters().rejected_total());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::ServerProgramOptions options;
  dance::CommandLine line(
      "The tunnel's server: forwards each guest's newest pose to everybody in the room.",
      "dance server");
  line.add("--port", options.port, "UDP port").range(1, 65535).shows_default();
  line.add(
          "--bind", options.bind,
          "address to listen on: 127.0.0.1 = this machine only, :: = all addresses, IPv4 and IPv6; "
          "0.0.0.0 = all of IPv4")
      .shows_default();
  line.add("--max-sessions", options.limits.sessions, "links at a time")
      .range(1, 10'000)
      .shows_default();
  line.add("--max-sessions-per-key", options.limits.sessions_per_key,
           "links at a time with the key of one guest; keys of rooms may have half of all")
      .range(1, 10'000)
      .shows_default();
  line.add("--max-guests-per-key", options.limits.guests_per_key,
           "guests in a room with the key of one guest; keys of rooms may have half of all")
      .range(1, static_cast<int>(dance::wire::kSlotsPerPage))
      .shows_default();
  line.add("--avatar-memory", options.avatar_memory_mb,
           "megabytes of memory for files of avatars, while their guests are here; 0 = none pass")
      .range(0, 4096)
      .shows_default();
  line.add("--max-rooms", options.limits.rooms, "rooms at a time").range(1, 10'000).shows_default();
  line.add("--max-guests", options.limits.guests_per_room, "guests in a room")
      .range(1, static_cast<int>(dance::wire::kSlotsPerPage))
      .shows_default();
  line.add("--max-listeners", options.limits.listeners_per_room,
           "links in a room that bring no guests")
      .range(0, 10'000)
      .shows_default();
  line.add(
          "--share-ms", options.share_ms,
          "how long a pose waits for others to share a datagram with: more saves bytes, 0 = not at "
          "all (else only where a line or this server cannot do without, to 4)")
      .range(0, 20);
  dance::add_cluster_options(
      line, options.cluster,
      "NATS servers that join this server with others, as nats://A:4222,nats://B:4222: a room is "
      "wherever one of its guests is");
  line.add("--cluster-replicas", options.cluster.nats.replicas,
           "how many NATS servers keep each value (else 3 where three are named, or 1)")
      .range(1, 5);
  line.add("--cluster-address", options.cluster.address,
           "HOST:PORT as guests reach this server, told to those of the others");
  line.add("--metrics", options.metrics,
           "HOST:PORT of a page of metrics for Prometheus; none unless asked for");
  dance::add_key_options(line, options.keys);
  line.add("--keys", options.key_file,
           "file of keys (else server-keys in the folder of the user's settings)");
  line.add("--certificate", options.certificates.chain,
           "PEM file with this server's certificate and its chain, for links that have one too");
  line.add("--private-key", options.certificates.private_key, "PEM file of its private key");
  line.add(
      "--authorities", options.certificates.authorities,
      "PEM file of those whose signature lets a guest in, under the certificate's common name");
  line.add_flag("--json", options.json, "write a summary to stdout at the end");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_server(options); });
}
