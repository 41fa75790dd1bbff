// A snapshot of a server's cluster: NATS, the other servers, and what passes between them in each
// room.
//
// Units/frames: Durations of this process's clock; counts since the server began, or, of a room,
//               since the other server came into it.
// Ownership:    owns its values and refers to nothing.
// Threads:      made in the node's thread; may go to any.
// Failure:      none; what is not known is not set.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tunnel/cluster/cluster_node.h"
#include "tunnel/nats/nats_bus.h"

namespace dance {

struct ClusterPeerStatus {
  ServerId id = 0;
  std::string address;  // as guests reach it; may be empty
  bool is_alive = true;
  Duration last_heard;
  std::optional<Duration> round_trip;
  std::uint32_t links = 0;
  std::uint32_t guests = 0;
};

// To one other server, in one room.
struct ClusterLinkStatus {
  wire::RoomName room;
  ServerId peer = 0;
  std::size_t guests = 0;  // that came through it
  RemoteMeter meter;
  std::uint64_t poses_lost = 0;  // of its guests, on the way from their house to here
  std::uint64_t poses_late = 0;
  std::optional<double> loss_there;  // from it to its worst receiver; none: it has none
  std::optional<Duration> round_trip_there;
};

struct ClusterStatus {
  ServerId id = 0;
  std::string address;
  ServerId clock_server = 0;  // whose clock is the cluster's; may be id
  Duration clock_offset;      // the cluster's less this process's
  std::optional<Duration> clock_round_trip;
  std::uint64_t clock_steps = 0;
  std::uint32_t links = 0;
  std::uint32_t guests = 0;
  std::size_t keys = 0;
  NatsBus::Counters nats;
  NatsBus::Counters nats_keys;  // of the connection for keys
  ClusterNode::Counters node;
  std::uint64_t deaths = 0;  // times that another server fell silent
  ServerRemotes::Counters remotes;
  std::vector<ClusterPeerStatus> peers;
  std::vector<ClusterLinkStatus> between;
};

// But for what only NATS and the keys know.
ClusterStatus cluster_status_of(const ClusterNode& node, const ServerCore& core, MonoTime now);
// 16 hexadecimal digits, as in NATS subjects.
std::string server_id_text(ServerId id);

}  // namespace dance
