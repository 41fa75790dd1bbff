#include "tunnel/cluster/cluster_peers.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

// Silent for so long is dead: its guests may come back through any other server.
constexpr Duration kDeath = Duration::ms(900);
// Silent for so long is dead where another server says so.
constexpr Duration kSilence = Duration::ms(450);
// Those who have not come back by then have left.
constexpr Duration kGrace = Duration::s(6);
// Until the clock is known, and from then on.
constexpr Duration kFirstQuestions = Duration::ms(20);
constexpr Duration kQuestions = Duration::ms(500);
constexpr Duration kLongestAnswer = Duration::s(2);

}  // namespace

void ClusterPeers::take_rank() {
  for (const auto& [id, peer] : peers_)
    if (peer.is_alive && peer.beat.born_us != INT64_MAX)
      born_us_ = std::max(born_us_, peer.beat.born_us + 1);
}

bool ClusterPeers::take(const cluster::Heartbeat& beat, MonoTime now) {
  if (beat.server == self_ || (!peers_.contains(beat.server) && peers_.size() >= kMost))
    return false;
  Peer& peer = peers_[beat.server];
  peer.beat = beat;
  peer.heard = now;
  peer.is_alive = !beat.is_leaving;
  if (beat.is_leaving || !forgotten_.contains(beat.server)) return false;
  forgotten_.erase(beat.server);
  return true;
}

void ClusterPeers::take(const cluster::ClockAnswer& answer, MonoTime now) {
  const auto peer = peers_.find(answer.server);
  const MonoTime asked = MonoTime::from_us(answer.asked_us);
  if (peer == peers_.end() || asked > now || now - asked > kLongestAnswer) return;
  peer->second.round_trip = now - asked;
  if (answer.server == followed_) clock_.add({asked, answer.received_us, answer.sent_us, now});
}

void ClusterPeers::expect(ServerId server, MonoTime since) {
  if (server == self_ || peers_.contains(server) || peers_.size() >= kMost) return;
  peers_[server].beat.server = server;
  peers_[server].beat.born_us = INT64_MAX;  // leads nobody
  peers_[server].heard = since;
}

std::vector<ServerId> ClusterPeers::forget_silent(MonoTime now) {
  std::vector<ServerId> forgotten;
  for (auto it = peers_.begin(); it != peers_.end();) {
    Peer& peer = it->second;
    if (peer.is_alive && now - peer.heard > kDeath) {
      peer.is_alive = false;
      ++deaths_;
    }
    if (now - peer.heard <= kGrace) {
      ++it;
      continue;
    }
    if (forgotten_.is_full()) forgotten_.erase_at(0);
    const bool pushed = forgotten_.try_push(it->first);
    DANCE_ASSERT(pushed);
    forgotten.push_back(it->first);
    it = peers_.erase(it);
  }
  return forgotten;
}

void ClusterPeers::advance(MonoTime now) {
  const ServerId first = leader();
  if (first != followed_) {
    followed_ = first;
    clock_.begin();
  }
  clock_.advance(now);
}

std::vector<ServerId> ClusterPeers::ask(MonoTime now) {
  std::vector<ServerId> asked;
  if (now < next_question_) return asked;
  const bool is_new = followed_ != self_ && !clock_.is_measured();
  next_question_ = now + (is_new ? kFirstQuestions : kQuestions);
  for (const auto& [id, peer] : peers_)
    if (peer.is_alive && (!is_new || id == followed_)) asked.push_back(id);
  return asked;
}

bool ClusterPeers::is_dead(ServerId server) const {
  const auto peer = peers_.find(server);
  return peer != peers_.end() && !peer->second.is_alive;
}

bool ClusterPeers::is_silent(ServerId server, MonoTime now) const {
  const auto peer = peers_.find(server);
  return peer != peers_.end() && (!peer->second.is_alive || now - peer->second.heard > kSilence);
}

ServerId ClusterPeers::leader() const {
  std::pair first{born_us_, self_};
  for (const auto& [id, peer] : peers_)
    if (peer.is_alive) first = std::min(first, std::pair(peer.beat.born_us, id));
  return first.second;
}

wire::ServerList ClusterPeers::addresses() const {
  wire::ServerList servers;
  for (const auto& [id, peer] : peers_)
    if (peer.is_alive && peer.beat.address.is_set() && !servers.try_push(peer.beat.address)) break;
  return servers;
}

}  // namespace dance
