#include "tunnel/link/signals/link_channels.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/base/sequence.h"

namespace dance {
namespace {

// A moment's hurry is no flood: so much may come at once.
TokenBucket bucket_of(const ChannelRule& rule) {
  return TokenBucket(rule.rate_hz, std::max(1.0, rule.rate_hz * 0.25));
}

}  // namespace

LinkChannels::LinkChannels(LinkContext& link, LinkSender& sender) : link_(link), sender_(sender) {
  channels_.reserve(kMaxHouseChannels);
  announce_streams();
}

wire::State LinkChannels::state_of(const Channel& channel) {
  return {{wire::StateKind::kChannel, channel.index},
          channel.slot,
          {},
          channel.state.version,
          channel.state.bytes()};
}

bool LinkChannels::is_due(const Channel& channel) const {
  return link_.is_due(channel.state, {wire::StateKind::kChannel, channel.index}, channel.slot);
}

// Streams whose names are known go by them before their first message does, so that it is not lost.
void LinkChannels::announce_streams() {
  for (const ChannelRule& rule : link_.options.channels) {
    if (!rule.is_out || rule.kind != ChannelClass::kNewest || rule.pattern.is_prefix()) continue;
    if (Channel* channel = find_or_add(rule.pattern.text(), rule)) set_payload(*channel, {});
  }
}

void LinkChannels::set_payload(Channel& channel, wire::Bytes message) {
  std::array<std::uint8_t, wire::kMaxStatePayload> payload;
  const std::size_t size =
      wire::build(wire::ChannelPayload{channel.rule->kind, channel.name, message}, payload);
  DANCE_ASSERT(size > 0);
  channel.state.change({payload.data(), size});
}

void LinkChannels::send(std::string_view name, wire::Bytes message, MonoTime now,
                        const GuestId& guest) {
  const ChannelRule* rule = find_rule_out(link_.options.channels, name);
  if (rule == nullptr) {
    ++link_.counters.channels_unlisted;
    return;
  }
  if (message.empty() || !rule->admits(message)) {
    ++link_.counters.channels_invalid;
    return;
  }
  Channel* channel = find_or_add(name, *rule);
  if (channel == nullptr) return;
  if (guest.is_set()) channel->guest = guest;
  const bool is_state = rule->kind == ChannelClass::kState;
  set_payload(*channel, is_state ? message : wire::Bytes());
  if (!link_.is_connected() || !bind(*channel)) {
    // A state waits; of a stream the next one is better.
    if (!is_state) ++link_.counters.channels_unrouted;
    return;
  }
  if (is_state || channel->sent_version == 0) {
    if (take_due(*channel, now))
      link_.send_state(state_of(*channel));
    else if (is_state && is_due(*channel))
      ++link_.counters.channels_limited;  // for now: its newest goes with a ping
  }
  if (!is_state) send_record(*channel, message, now);
}

void LinkChannels::send_record(Channel& channel, wire::Bytes message, MonoTime now) {
  if (!channel.changes.take(1.0, now)) {
    ++link_.counters.channels_limited;
    return;
  }
  wire::Record record;
  record.kind = wire::RecordKind::kChannel;
  record.slot = channel.slot.slot;
  record.channel = channel.index;
  record.sequence = ++channel.sequence;
  record.payload = message;
  ++link_.counters.channels_sent;
  sender_.add(record, now);
}

LinkChannels::Channel* LinkChannels::find_or_add(std::string_view name, const ChannelRule& rule) {
  for (Channel& channel : channels_)
    if (channel.name == name) return &channel;
  if (channels_.size() == channels_.capacity()) {
    ++link_.counters.channels_overflow;
    return nullptr;
  }
  Channel& channel = channels_.emplace_back();
  [[maybe_unused]] const bool fits = channel.name.assign(name);
  channel.rule = &rule;
  channel.guest = rule.guest;
  channel.changes = bucket_of(rule);
  return &channel;
}

// Gives it a guest that has a slot, and there an index that no other has.
bool LinkChannels::bind(Channel& channel) {
  const auto owner =
      std::find_if(link_.locals.begin(), link_.locals.end(), [&](const LocalGuest& guest) {
        return guest.has_slot && (channel.guest.is_set() ? guest.id == channel.guest : true);
      });
  if (owner == link_.locals.end()) {
    channel.is_bound = false;
    return false;
  }
  const wire::Slot& slot = owner->slot;
  if (channel.is_bound && channel.slot == slot) return true;
  std::array<bool, kMaxChannelsPerGuest> is_taken{};
  for (const Channel& other : channels_)
    if (&other != &channel && other.is_bound && other.slot == slot) is_taken[other.index] = true;
  const auto free = std::find(is_taken.begin(), is_taken.end(), false);
  channel.is_bound = free != is_taken.end();
  if (!channel.is_bound) {
    ++link_.counters.channels_overflow;
    return false;
  }
  channel.slot = slot;
  channel.index = static_cast<std::uint8_t>(free - is_taken.begin());
  link_.stream.states.forget({wire::StateKind::kChannel, channel.index}, slot.slot);
  channel.sent_version = 0;
  return true;
}

// A version that was sent before may be repeated; a new one costs of the rule's rate.
bool LinkChannels::take_due(Channel& channel, MonoTime now) {
  if (!bind(channel) || !is_due(channel)) return false;
  const bool is_free =
      channel.sent_version == channel.state.version || channel.rule->kind == ChannelClass::kNewest;
  if (!is_free && !channel.changes.take(1.0, now)) return false;
  if (!is_free) ++link_.counters.channels_sent;
  channel.sent_version = channel.state.version;
  return true;
}

// False where it is to come again, as it comes too fast.
bool LinkChannels::on_state(RemoteGuest& remote, const wire::State& state, MonoTime now) {
  RemoteChannel& channel = remote.heard.channels[state.name.index];
  const auto payload = wire::parse_channel(state.payload);
  if (!payload) {
    channel = RemoteChannel();
    ++link_.counters.channels_invalid;
    ++remote.counts.invalid;
    return true;
  }
  if (!channel.is_named || channel.name != payload->name) {
    channel = RemoteChannel();
    channel.is_named = true;
    channel.name = payload->name;
    channel.rule = find_rule_in(link_.options.channels, channel.name.view());
    if (channel.rule != nullptr && channel.rule->kind != payload->kind) channel.rule = nullptr;
    if (channel.rule != nullptr) channel.messages = bucket_of(*channel.rule);
  }
  const bool is_state = payload->kind == ChannelClass::kState;
  if (channel.rule == nullptr || channel.rule->kind != payload->kind) {
    if (is_state) ++link_.counters.channels_unlisted;
    return true;
  }
  if (!is_state) return true;
  if (!channel.messages.take(1.0, now)) {
    ++link_.counters.channels_limited;
    return false;
  }
  deliver(remote, channel, payload->message, now);
  return true;
}

void LinkChannels::on_record(const wire::Record& record, MonoTime now) {
  RemoteGuest& remote = link_.remotes[record.slot];
  if (!remote.in_use || remote.is_ours || (record.stream >> 16 & 15) != (remote.generation & 15u)) {
    ++link_.counters.channels_unrouted;
    return;
  }
  RemoteChannel& channel = remote.heard.channels[record.channel];
  if (!channel.is_named || channel.rule == nullptr) {
    ++(channel.is_named ? link_.counters.channels_unlisted : link_.counters.channels_unrouted);
    return;
  }
  if (channel.rule->kind != ChannelClass::kNewest) {
    ++link_.counters.channels_invalid;
    return;
  }
  if (channel.has_any && !is_newer_sequence(record.sequence, channel.sequence)) {
    ++link_.counters.channels_late;
    return;
  }
  channel.has_any = true;
  channel.sequence = record.sequence;
  if (!channel.messages.take(1.0, now)) {
    ++link_.counters.channels_limited;
    return;
  }
  deliver(remote, channel, record.payload, now);
}

void LinkChannels::deliver(RemoteGuest& remote, const RemoteChannel& channel, wire::Bytes message,
                           MonoTime now) {
  if (!channel.rule->admits(message)) {
    ++link_.counters.channels_invalid;
    ++remote.counts.invalid;
    return;
  }
  ++link_.counters.channels_delivered;
  if (link_.handlers.on_channel)
    link_.handlers.on_channel(remote.id, channel.name.view(), channel.rule->kind, message, now);
}

}  // namespace dance
