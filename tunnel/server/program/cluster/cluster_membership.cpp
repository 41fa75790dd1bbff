#include "tunnel/server/program/cluster/cluster_membership.h"

#include <algorithm>
#include <chrono>

#include "core/net/mono_clock.h"
#include "core/net/secure_random.h"
#include "core/program/talk.h"
#include "tunnel/nats/values/nats_store.h"

namespace dance {
namespace {

constexpr Duration kJoinsWithin = Duration::s(10);
constexpr Duration kJoinTurn = Duration::ms(5);
// Servers write what stands several times as often (ClusterNode).
constexpr int kRoomsLast_s = 2 * 24 * 3600;
// Seconds to wait for keys that NATS still has, or that another operator writes again.
constexpr int kChecksUntilLost = 5;

std::string_view text_in(ClusterBus::Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Result<std::unique_ptr<ClusterMembership>> ClusterMembership::join(const ClusterOptions& options,
                                                                   Poller& poller) {
  DANCE_TRY(const NatsOptions nats, nats_options_of(options));
  ClusterNode::Options of;
  while (of.id == 0) of.id = secure_random_u64();
  of.born_us = std::chrono::duration_cast<std::chrono::microseconds>(
                   std::chrono::system_clock::now().time_since_epoch())
                   .count();
  if (!options.address.empty()) {
    DANCE_TRY(of.address, Address::resolve(options.address, options.port));
  }
  std::unique_ptr<ClusterMembership> membership(new ClusterMembership);
  NatsOptions rooms = nats;
  rooms.lasts_s = kRoomsLast_s;
  DANCE_TRY(membership->bus_, NatsBus::connect(rooms, poller));
  membership->node_ = std::make_unique<ClusterNode>(of, *membership->bus_);
  if (auto read = membership->read_keys(nats, poller); !read)
    return tl::make_unexpected(read.error());
  if (auto settled = membership->settle(nats, poller); !settled)
    return tl::make_unexpected(settled.error());
  return membership;
}

// All that are there, before the first guest knocks; then each change.
Result<void> ClusterMembership::read_keys(const NatsOptions& nats, Poller& poller) {
  NatsOptions of = nats;
  of.bucket = kKeysBucket;
  of.only_values = true;
  of.name += " keys";
  DANCE_TRY(const auto store, NatsStore::connect(of));
  DANCE_TRY(const auto values, store->read_all());
  for (const auto& [name, value] : values) keys_.take(name, value);
  DANCE_TRY(key_bus_, NatsBus::connect(of, poller));
  ClusterBus::Handlers handlers;
  handlers.on_message = [](std::string_view, ClusterBus::Bytes, MonoTime) {};
  handlers.on_value = [this](std::string_view name, std::optional<ClusterBus::Bytes> value,
                             MonoTime) {
    keys_.take(name, value ? std::optional(text_in(*value)) : std::nullopt);
  };
  handlers.on_all_read = [](std::string_view, MonoTime) {};
  handlers.on_back = [](MonoTime) {};
  handlers.on_emptied = [this](MonoTime) {
    keys_.expect_again();
    checks_until_lost_ = kChecksUntilLost;
  };
  key_bus_->set_handlers(std::move(handlers));
  // Many may come at once: after a break all do.
  key_bus_->set_after_batch([this](MonoTime) {
    if (keys_.take_changed() && on_keys_) on_keys_();
  });
  key_bus_->watch(">");
  return {};
}

Result<void> ClusterMembership::settle(const NatsOptions& nats, Poller& poller) {
  const MonoTime begin = mono_now();
  while (!node_->is_settled(mono_now())) {
    if (poller.is_stopped()) return fail("ended before the cluster was joined");
    if (mono_now() - begin > kJoinsWithin)
      return fail("no server of the cluster at " + shown_urls(nats) + " tells the time");
    node_->tick(mono_now());
    node_->end_turn(mono_now());
    poller.run_once(kJoinTurn);
  }
  return {};
}

void ClusterMembership::tell() {
  const auto others = static_cast<std::size_t>(std::ranges::count_if(
      node_->peers().all(), [](const auto& peer) { return peer.second.is_alive; }));
  if (others != told_others_)
    talk::info("{} other servers are in the cluster now", told_others_ = others);
  if (const auto wrong = keys_.take_wrong()) talk::warn("{}", *wrong);
  if (checks_until_lost_ > 0 && --checks_until_lost_ == 0)
    if (const auto lost = keys_.take_lost()) talk::warn("{}", *lost);
  const NatsBus::Counters now = bus_->counters();
  if (std::exchange(emptied_, now.emptied) != now.emptied)
    talk::warn(
        "NATS has lost its values: is its disk another? The rooms of this server are written "
        "again");
  const bool has_come_back = std::exchange(reconnects_, now.reconnects) != now.reconnects;
  const bool was_connected = std::exchange(was_connected_, now.is_connected);
  if (now.is_connected && (has_come_back || !was_connected)) {
    talk::info("NATS answers again");
  } else if (was_connected && !now.is_connected) {
    talk::warn(
        "NATS does not answer: links of this server dance on with each other, and its keys stay as "
        "they are, until it comes back by itself");
  }
}

}  // namespace dance
