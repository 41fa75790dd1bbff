#include "tunnel/server/program/cluster/cluster_status_json.h"

namespace dance {
namespace {

void add_bus(const char* name, const NatsBus::Counters& bus, StatusJsonText& json) {
  json.key(name);
  json.open('{');
  json.flag("connected", bus.is_connected);
  json.member("reconnects", bus.reconnects);
  json.member("dropped_in", bus.dropped_in);
  json.member("dropped_out", bus.dropped_out);
  json.member("failed_values", bus.failed_values);
  json.member("unwritten_values", std::uint64_t{bus.unwritten_values});
  json.close('}');
}

void add_peer(const ClusterPeerStatus& peer, bool leads, StatusJsonText& json) {
  json.next();
  json.open('{');
  json.member("id", server_id_text(peer.id));
  json.member("address", peer.address);
  json.flag("alive", peer.is_alive);
  json.flag("leads_clock", leads);
  json.member("last_heard_s", peer.last_heard.as_seconds());
  json.member("round_trip_ms", ms_of(peer.round_trip));
  json.member("links", std::uint64_t{peer.links});
  json.member("guests", std::uint64_t{peer.guests});
  json.close('}');
}

void add_between(const ClusterLinkStatus& link, StatusJsonText& json) {
  json.next();
  json.open('{');
  json.member("room", link.room.view());
  json.member("server", server_id_text(link.peer));
  json.member("guests", std::uint64_t{link.guests});
  json.member("records_in", link.meter.records_in);
  json.member("records_out", link.meter.records_out);
  json.member("feedback_in", link.meter.feedback_in);
  json.member("feedback_out", link.meter.feedback_out);
  json.member("poses_lost", link.poses_lost);
  json.member("poses_late", link.poses_late);
  json.member("loss_there", link.loss_there);
  json.member("round_trip_there_ms", ms_of(link.round_trip_there));
  json.close('}');
}

void add_totals(const ClusterStatus& cluster, StatusJsonText& json) {
  const ClusterNode::Counters& node = cluster.node;
  json.key("totals");
  json.open('{');
  json.member("messages_in", node.messages_in);
  json.member("messages_out", node.messages_out);
  json.member("bytes_in", node.bytes_in);
  json.member("bytes_out", node.bytes_out);
  json.member("records_in", node.records_in);
  json.member("records_out", node.records_out);
  json.member("voices_in", node.voices_in);
  json.member("voices_out", node.voices_out);
  json.member("values_in", node.values_in);
  json.member("malformed", node.malformed);
  json.member("other_codecs", node.other_codecs);
  json.member("deaths", cluster.deaths);
  json.member("guests_without_place", cluster.remotes.guests_without_place);
  json.member("servers_without_place", cluster.remotes.servers_without_place);
  json.member("unknown", cluster.remotes.unknown);
  json.close('}');
}

}  // namespace

void add_json(const ClusterStatus& cluster, StatusJsonText& json) {
  json.key("cluster");
  json.open('{');
  json.member("id", server_id_text(cluster.id));
  json.member("address", cluster.address);
  json.member("clock_server", server_id_text(cluster.clock_server));
  json.member("clock_offset_ms", cluster.clock_offset.as_ms());
  json.member("clock_round_trip_ms", ms_of(cluster.clock_round_trip));
  json.member("clock_steps", cluster.clock_steps);
  json.member("links", std::uint64_t{cluster.links});
  json.member("guests", std::uint64_t{cluster.guests});
  json.member("keys", std::uint64_t{cluster.keys});
  add_bus("nats", cluster.nats, json);
  add_bus("nats_keys", cluster.nats_keys, json);
  json.key("servers");
  json.open('[');
  for (const ClusterPeerStatus& peer : cluster.peers)
    add_peer(peer, peer.id == cluster.clock_server, json);
  json.close(']');
  json.key("between");
  json.open('[');
  for (const ClusterLinkStatus& link : cluster.between) add_between(link, json);
  json.close(']');
  add_totals(cluster, json);
  json.close('}');
}

}  // namespace dance
