#include "tunnel/server/program/cluster/cluster_status.h"

#include <fmt/format.h>

#include <algorithm>

namespace dance {
namespace {

// As in PathFeedback.
constexpr double kWholeLoss = 65'536.0;
constexpr Duration kFeedbackRoundTripUnit = Duration::us(100);

ClusterLinkStatus between_of(const ServerCore& core, const ServerSession& session) {
  const ServerRoom& room = core.rooms()[session.room];
  const RemoteReceivers& there = core.remote_receivers()[session.remote];
  ClusterLinkStatus link;
  link.room = room.name;
  link.peer = there.server;
  link.guests = session.slots.size();
  link.meter = there.meter;
  for (const std::uint8_t slot : session.slots) {
    const StreamGate::Counters& poses = room.guests[slot].poses.counters();
    link.poses_lost += poses.lost;
    link.poses_late += poses.late;
  }
  if (there.path.has_receiver) {
    link.loss_there = there.path.loss / kWholeLoss;
    link.round_trip_there = kFeedbackRoundTripUnit * there.path.round_trip;
  }
  return link;
}

}  // namespace

std::string server_id_text(ServerId id) { return fmt::format("{:016x}", id); }

ClusterStatus cluster_status_of(const ClusterNode& node, const ServerCore& core, MonoTime now) {
  ClusterStatus status;
  status.id = node.id();
  if (node.address().is_set()) status.address = node.address().to_string();
  status.clock_server = node.peers().followed();
  status.clock_offset = node.clock().offset();
  if (node.clock().is_measured()) status.clock_round_trip = node.clock().round_trip();
  status.clock_steps = node.clock().steps();
  status.links = static_cast<std::uint32_t>(core.session_count());
  status.guests = static_cast<std::uint32_t>(core.guest_count());
  status.node = node.counters();
  status.deaths = node.peers().deaths();
  status.remotes = core.remotes().counters();
  for (const auto& [id, peer] : node.peers().all()) {
    ClusterPeerStatus about;
    about.id = id;
    if (peer.beat.address.is_set()) about.address = peer.beat.address.to_string();
    about.is_alive = peer.is_alive;
    about.last_heard = std::max(Duration(), now - peer.heard);
    if (peer.round_trip > Duration()) about.round_trip = peer.round_trip;
    about.links = peer.beat.links;
    about.guests = peer.beat.guests;
    status.peers.push_back(std::move(about));
  }
  for (const ServerSession& session : core.sessions())
    if (session.in_use && session.is_remote()) status.between.push_back(between_of(core, session));
  std::sort(status.between.begin(), status.between.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.room, a.peer) < std::tuple(b.room, b.peer);
  });
  return status;
}

}  // namespace dance
