#include "tunnel/link/link_bus.h"

namespace dance {

template <class Message>
auto LinkBus::publisher(Signal signal, std::optional<Message> Known::*place) {
  return [this, signal, place](const GuestId& guest, const Message& message, MonoTime) {
    known_[guest].*place = message;
    bus_.publish(Channel::of(signal, Where::kGuest, guest), message);
  };
}

LinkHandlers LinkBus::handlers() {
  LinkHandlers handlers;
  handlers.on_pose = [this](const GuestId& guest, const Pose& pose, MonoTime) {
    bus_.publish(Channel::of(Signal::kPose, Where::kGuest, guest), pose);
  };
  handlers.on_hands = [this](const GuestId& guest, const Hands& hands, MonoTime) {
    bus_.publish(Channel::of(Signal::kHands, Where::kGuest, guest), hands);
  };
  handlers.on_skeleton = [this](const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
    known_[guest].skeleton = skeleton;
    bus_.publish(Channel::of(Signal::kSkeleton, Where::kGuest, guest), {skeleton, now, clock_id_});
  };
  handlers.on_avatar = publisher<Avatar>(Signal::kAvatar, &Known::avatar);
  handlers.on_style = publisher<Style>(Signal::kStyle, &Known::style);
  handlers.on_placement = publisher<Placement>(Signal::kPlacement, &Known::placement);
  handlers.on_music = [this](const GuestId& setter, const Music& music, MonoTime) {
    bus_.publish(Channel::of(Signal::kMusic, Where::kRoom, setter), music);
  };
  handlers.on_scene = [this](const GuestId& setter, const Scene& scene, MonoTime) {
    scene_.emplace(setter, scene);
    bus_.publish(Channel::of(Signal::kScene, Where::kRoom, setter), scene);
  };
  handlers.on_channel = [this](const GuestId& guest, std::string_view name, ChannelClass kind,
                               wire::Bytes message,
                               MonoTime) { on_channel(guest, name, kind, message); };
  return handlers;
}

void LinkBus::on_channel(const GuestId& guest, std::string_view name, ChannelClass kind,
                         wire::Bytes message) {
  const auto channel = name_of_guest(name, guest);
  if (kind == ChannelClass::kState) {
    auto& channels = known_[guest].channels;
    const std::string key(channel.view());
    // Who changes names all the time fills nobody's memory.
    if (channels.contains(key) || channels.size() < kMaxChannelsPerGuest)
      channels[key].assign(message.begin(), message.end());
  }
  bus_.publish_raw(channel.c_str(), message.data(), message.size());
}

void LinkBus::send_captures_of(const GuestId& guest) {
  if (!hears_beats_)
    bus_.on_beat([this](const Channel&, const Beat& beat, MonoTime) { tag_.hear(beat); });
  hears_beats_ = true;
  bus_.on_pose(Where::kCapture, guest, Delivery::kEvery,
               [this](const Channel& channel, const Pose& pose, MonoTime now) {
                 Pose tagged = pose;
                 tag_.tag(tagged);
                 link_->send(channel.guest(), tagged, now);
               });
  bus_.on_hands(Where::kCapture, guest, Delivery::kEvery,
                [this](const Channel& channel, const Hands& hands, MonoTime now) {
                  link_->send(channel.guest(), hands, now);
                });
  bus_.on_skeleton(Where::kCapture, guest,
                   [this](const Channel& channel, const TimedSkeleton& timed, MonoTime now) {
                     link_->send(channel.guest(), timed.skeleton, now);
                   });
}

void LinkBus::send_states_of(const GuestId& guest) {
  const auto send = [this](const Channel& channel, const auto& message, MonoTime now) {
    link_->send(channel.guest(), message, now);
  };
  bus_.on_music(Where::kCapture, guest, send);
  bus_.on_scene(Where::kCapture, guest, send);
  bus_.on_avatar(Where::kCapture, guest, send);
  bus_.on_style(Where::kCapture, guest, send);
  bus_.on_placement(Where::kCapture, guest, send);
}

void LinkBus::send_channels(const std::vector<ChannelRule>& rules) {
  rules_ = rules;
  for (const ChannelRule& rule : rules_) {
    if (!rule.is_out) continue;
    // Longer ones too, a little: the link counts them.
    bus_.on_raw(rule.pattern, Delivery::kNewest, 2 * kMaxChannelNewestBytes,
                [this, rule = &rule](std::string_view name, const void* data, std::size_t size,
                                     MonoTime now) {
                  // A channel that two rules name is the first one's.
                  if (find_rule_out(rules_, name) == rule)
                    link_->send_channel(name, {static_cast<const std::uint8_t*>(data), size}, now);
                });
  }
}

void LinkBus::forget(const GuestId& guest) { known_.erase(guest); }

template <class Message>
void LinkBus::publish_known(Signal signal, const GuestId& guest, std::optional<Message>& message,
                            MonoTime now) {
  if (!message) return;
  message->time = now;
  bus_.publish(Channel::of(signal, Where::kGuest, guest), *message);
}

void LinkBus::publish_second(MonoTime now) {
  for (auto& [guest, known] : known_) {
    if (known.skeleton)
      bus_.publish(Channel::of(Signal::kSkeleton, Where::kGuest, guest),
                   {*known.skeleton, now, clock_id_});
    publish_known(Signal::kAvatar, guest, known.avatar, now);
    publish_known(Signal::kStyle, guest, known.style, now);
    publish_known(Signal::kPlacement, guest, known.placement, now);
    for (const auto& [name, message] : known.channels)
      bus_.publish_raw(name.c_str(), message.data(), message.size());
  }
  if (scene_) {
    scene_->second.time = now;
    bus_.publish(Channel::of(Signal::kScene, Where::kRoom, scene_->first), scene_->second);
  }
  if (link_ == nullptr) return;
  // As the clocks stand now, which is better than when it came.
  if (const auto music = link_->room_music(now))
    bus_.publish(Channel::of(Signal::kMusic, Where::kRoom, link_->room_music_setter()), *music);
  bus_.publish(Channel::of_program(Signal::kStats, "link"), link_->stats(now));
}

}  // namespace dance
