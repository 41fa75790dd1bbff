// Further channels of this house and of the others, as the house's rules let them pass.
#include <algorithm>

#include "core/base/assert.h"
#include "core/base/sequence.h"
#include "tunnel/link/link_core.h"

namespace dance {
namespace {

// A moment's hurry is no flood: so much may come at once.
TokenBucket bucket_of(const ChannelRule& rule) {
  return TokenBucket(rule.rate_hz, std::max(1.0, rule.rate_hz * 0.25));
}

}  // namespace

// Streams whose names are known go by them before their first message does, so that it is not lost.
void LinkCore::announce_streams() {
  for (const ChannelRule& rule : options_.channels) {
    if (!rule.is_out || rule.kind != ChannelClass::kNewest || rule.pattern.is_prefix()) continue;
    if (HouseChannel* channel = find_or_add_channel(rule.pattern.text(), rule))
      set_payload(*channel, {});
  }
}

void LinkCore::set_payload(HouseChannel& channel, wire::Bytes message) {
  std::array<std::uint8_t, wire::kMaxStatePayload> payload;
  const std::size_t size =
      wire::build(wire::ChannelPayload{channel.rule->kind, channel.name, message}, payload);
  DANCE_ASSERT(size > 0);
  channel.state.change({payload.data(), size});
}

void LinkCore::send_channel(std::string_view name, wire::Bytes message, MonoTime now) {
  const ChannelRule* rule = find_rule_out(options_.channels, name);
  if (rule == nullptr) {
    ++counters_.channels_unlisted;
    return;
  }
  if (message.empty() || !rule->admits(message)) {
    ++counters_.channels_invalid;
    return;
  }
  HouseChannel* channel = find_or_add_channel(name, *rule);
  if (channel == nullptr) return;
  const bool is_state = rule->kind == ChannelClass::kState;
  set_payload(*channel, is_state ? message : wire::Bytes());
  if (!is_connected() || !bind_channel(*channel)) {
    // A state waits; of a stream the next one is better.
    if (!is_state) ++counters_.channels_unrouted;
    return;
  }
  if (is_state || channel->sent_version == 0) {
    if (is_channel_due(*channel, now))
      send_state({{wire::StateKind::kChannel, channel->index},
                  channel->slot,
                  {},
                  channel->state.version,
                  channel->state.bytes()});
    else if (is_state &&
             is_due(channel->state, {wire::StateKind::kChannel, channel->index}, channel->slot))
      ++counters_.channels_limited;  // for now: its newest goes with a ping
  }
  if (!is_state) send_channel_record(*channel, message, now);
}

void LinkCore::send_channel_record(HouseChannel& channel, wire::Bytes message, MonoTime now) {
  if (!channel.changes.take(1.0, now)) {
    ++counters_.channels_limited;
    return;
  }
  wire::Record record;
  record.kind = wire::RecordKind::kChannel;
  record.slot = channel.slot.slot;
  record.channel = channel.index;
  record.sequence = ++channel.sequence;
  record.payload = message;
  ++counters_.channels_sent;
  add_record(record, now);
}

HouseChannel* LinkCore::find_or_add_channel(std::string_view name, const ChannelRule& rule) {
  for (HouseChannel& channel : channels_)
    if (channel.name == name) return &channel;
  if (channels_.size() == channels_.capacity()) {
    ++counters_.channels_overflow;
    return nullptr;
  }
  HouseChannel& channel = channels_.emplace_back();
  [[maybe_unused]] const bool fits = channel.name.assign(name);
  channel.rule = &rule;
  channel.changes = bucket_of(rule);
  return &channel;
}

// Gives it a guest that has a slot, and there an index that no other has.
bool LinkCore::bind_channel(HouseChannel& channel) {
  const auto owner = std::find_if(locals_.begin(), locals_.end(), [&](const LocalGuest& guest) {
    return guest.has_slot &&
           (channel.rule->guest.is_set() ? guest.id == channel.rule->guest : true);
  });
  if (owner == locals_.end()) {
    channel.is_bound = false;
    return false;
  }
  const wire::Slot& slot = owner->slot;
  if (channel.is_bound && channel.slot == slot) return true;
  std::array<bool, kMaxChannelsPerGuest> is_taken{};
  for (const HouseChannel& other : channels_)
    if (&other != &channel && other.is_bound && other.slot == slot) is_taken[other.index] = true;
  const auto free = std::find(is_taken.begin(), is_taken.end(), false);
  channel.is_bound = free != is_taken.end();
  if (!channel.is_bound) {
    ++counters_.channels_overflow;
    return false;
  }
  channel.slot = slot;
  channel.index = static_cast<std::uint8_t>(free - is_taken.begin());
  stream_.states.forget({wire::StateKind::kChannel, channel.index}, slot.slot);
  channel.sent_version = 0;
  return true;
}

// A version that was sent before may be repeated; a new one costs of the rule's rate.
bool LinkCore::is_channel_due(HouseChannel& channel, MonoTime now) {
  if (!bind_channel(channel) ||
      !is_due(channel.state, {wire::StateKind::kChannel, channel.index}, channel.slot))
    return false;
  const bool is_free =
      channel.sent_version == channel.state.version || channel.rule->kind == ChannelClass::kNewest;
  if (!is_free && !channel.changes.take(1.0, now)) return false;
  if (!is_free) ++counters_.channels_sent;
  channel.sent_version = channel.state.version;
  return true;
}

// False where it is to come again, as it comes too fast.
bool LinkCore::on_channel_state(RemoteGuest& remote, const wire::State& state, MonoTime now) {
  RemoteChannel& channel = remote.channels[state.name.index];
  const auto payload = wire::parse_channel(state.payload);
  if (!payload) {
    channel = RemoteChannel();
    ++counters_.channels_invalid;
    ++remote.invalid;
    return true;
  }
  if (!channel.is_named || channel.name != payload->name) {
    channel = RemoteChannel();
    channel.is_named = true;
    channel.name = payload->name;
    channel.rule = find_rule_in(options_.channels, channel.name.view());
    if (channel.rule != nullptr && channel.rule->kind != payload->kind) channel.rule = nullptr;
    if (channel.rule != nullptr) channel.messages = bucket_of(*channel.rule);
  }
  const bool is_state = payload->kind == ChannelClass::kState;
  if (channel.rule == nullptr || channel.rule->kind != payload->kind) {
    if (is_state) ++counters_.channels_unlisted;
    return true;
  }
  if (!is_state) return true;
  if (!channel.messages.take(1.0, now)) {
    ++counters_.channels_limited;
    return false;
  }
  deliver_channel(remote, channel, payload->message, now);
  return true;
}

void LinkCore::on_channel_record(const wire::Record& record, MonoTime now) {
  RemoteGuest& remote = remotes_[record.slot];
  if (!remote.in_use || remote.is_ours || (record.stream >> 16 & 15) != (remote.generation & 15u)) {
    ++counters_.channels_unrouted;
    return;
  }
  RemoteChannel& channel = remote.channels[record.channel];
  if (!channel.is_named || channel.rule == nullptr) {
    ++(channel.is_named ? counters_.channels_unlisted : counters_.channels_unrouted);
    return;
  }
  if (channel.rule->kind != ChannelClass::kNewest) {
    ++counters_.channels_invalid;
    return;
  }
  if (channel.has_any && !is_newer_sequence(record.sequence, channel.sequence)) {
    ++counters_.channels_late;
    return;
  }
  channel.has_any = true;
  channel.sequence = record.sequence;
  if (!channel.messages.take(1.0, now)) {
    ++counters_.channels_limited;
    return;
  }
  deliver_channel(remote, channel, record.payload, now);
}

void LinkCore::deliver_channel(RemoteGuest& remote, const RemoteChannel& channel,
                               wire::Bytes message, MonoTime now) {
  if (!channel.rule->admits(message)) {
    ++counters_.channels_invalid;
    ++remote.invalid;
    return;
  }
  ++counters_.channels_delivered;
  if (handlers_.on_channel)
    handlers_.on_channel(remote.id, channel.name.view(), channel.rule->kind, message, now);
}

}  // namespace dance
