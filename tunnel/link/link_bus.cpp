#include "tunnel/link/link_bus.h"

#include "core/base/assert.h"
#include "core/codec/face_codec.h"
#include "core/net/mono_clock.h"
#include "tunnel/session/profile_bytes.h"

namespace dance {
namespace {

constexpr std::string_view kFaceChannels = "FACES/*";
constexpr std::string_view kFacePrefix = "FACES/";
constexpr double kMostFaces_hz = 120.0;
constexpr std::string_view kSpeechChannels = "SPEECH/*";
constexpr std::string_view kSpeechPrefix = "SPEECH/";
constexpr double kMostVoiceSigns_hz = 5.0;
constexpr std::string_view kProfileChannels = "NAMES/*";
constexpr double kMostProfiles_hz = 2.0;

bool is_own_channel(std::string_view pattern) {
  return pattern == kFaceChannels || pattern == kSpeechChannels || pattern == kProfileChannels;
}

bool is_own_name(std::string_view name) {
  return name.starts_with(kFacePrefix) || name.starts_with(kSpeechPrefix) ||
         name.starts_with(kProfilePrefix);
}

// The name of an own channel of a guest, as "FACES/alice".
class OwnName {
  static_assert(kFacePrefix.size() + kMaxGuestIdLength <= kMaxForeignName);
  static_assert(kSpeechPrefix.size() + kMaxGuestIdLength <= kMaxForeignName);
  static_assert(kProfilePrefix.size() + kMaxGuestIdLength <= kMaxForeignName);

 public:
  OwnName(std::string_view prefix, const GuestId& guest) {
    const std::string_view id = guest.view();
    const auto end = std::copy(prefix.begin(), prefix.end(), name_.begin());
    length_ = static_cast<std::size_t>(std::copy(id.begin(), id.end(), end) - name_.begin());
  }
  std::string_view view() const { return {name_.data(), length_}; }

 private:
  std::array<char, kMaxForeignName> name_;
  std::size_t length_ = 0;
};

}  // namespace

// As it comes.
template <class T>
auto LinkBus::publisher(Where where) {
  return [this, where](const GuestId& guest, const T& message, MonoTime) {
    port_.publish(where, guest, message);
  };
}

// And kept, to be said again.
template <class T>
auto LinkBus::keeper() {
  return [this](const GuestId& guest, const T& message, MonoTime) {
    std::get<std::optional<T>>(known_[guest].states) = message;
    port_.publish(Where::kGuest, guest, message);
  };
}

LinkHandlers LinkBus::handlers() {
  LinkHandlers handlers;
  handlers.on_pose = publisher<Pose>(Where::kGuest);
  handlers.on_hands = publisher<Hands>(Where::kGuest);
  handlers.on_voice = publisher<Voice>(Where::kGuest);
  handlers.on_skeleton = [this, keep = keeper<TimedSkeleton>()](
                             const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
    keep(guest, TimedSkeleton{skeleton, now, clock_id_}, now);
  };
  handlers.on_avatar = keeper<Avatar>();
  handlers.on_avatar_file = [this, keep = keeper<AvatarFile>()](
                                const GuestId& guest, const AvatarFile& file, MonoTime now) {
    keep(guest, file, now);
    if (avatars_ != nullptr) avatars_->hear(guest, file);
  };
  if (avatars_ != nullptr) avatars_->add_to(handlers);
  handlers.on_style = keeper<Style>();
  handlers.on_placement = keeper<Placement>();
  handlers.on_chat = publisher<Chat>(Where::kGuest);
  handlers.on_music = publisher<Music>(Where::kRoom);
  handlers.on_song = publisher<RoomSong>(Where::kRoom);
  handlers.on_scene = [this](const GuestId& setter, const Scene& scene, MonoTime) {
    scene_.emplace(setter, scene);
    port_.publish(Where::kRoom, setter, scene);
  };
  handlers.on_channel = [this](const GuestId& guest, std::string_view name, ChannelClass kind,
                               wire::Bytes message, MonoTime now) {
    const auto is_own = [&](std::string_view prefix, ChannelClass of_kind) {
      return kind == of_kind && name == OwnName(prefix, guest).view();
    };
    if (is_own(kFacePrefix, ChannelClass::kNewest))
      on_face(guest, message, now);
    else if (is_own(kSpeechPrefix, ChannelClass::kState))
      on_voice_sign(guest, message, now);
    else if (is_own(kProfilePrefix, ChannelClass::kState))
      on_profile(guest, message, now);
    else if (!is_own_name(name))  // one of another guest's, or of another class, is dropped
      on_channel(guest, name, kind, message);
  };
  return handlers;
}

void LinkBus::add_own_rules(std::vector<ChannelRule>& rules) {
  const auto add = [&](std::string_view name, ChannelClass kind, std::size_t most, double rate_hz) {
    ChannelRule rule;
    const auto pattern = ChannelPattern::parse(name);
    DANCE_ASSERT(pattern.has_value());
    rule.pattern = *pattern;
    rule.kind = kind;
    rule.max_bytes = most;
    rule.layout = *LayoutCheck::parse("any");
    rule.rate_hz = rate_hz;
    rules.insert(rules.begin(), rule);
  };
  add(kSpeechChannels, ChannelClass::kState, 1, kMostVoiceSigns_hz);
  add(kProfileChannels, ChannelClass::kState, kMaxProfileBytes, kMostProfiles_hz);
  add(kFaceChannels, ChannelClass::kNewest, kMaxFacePayload, kMostFaces_hz);
}

void LinkBus::send_face(const GuestId& guest, const Face& face, MonoTime now) {
  std::array<std::uint8_t, kMaxFacePayload> payload;
  const std::size_t size = encode_face(face, payload);
  if (size == 0) return;
  const OwnName name(kFacePrefix, guest);
  link_->send_channel(name.view(), {payload.data(), size}, now, guest);
}

// A house that plays no voices learns only from this byte who is talking.
void LinkBus::send_voice_signs_of(const GuestId& guest) {
  const auto send = [this](const GuestId& of, std::optional<std::uint8_t> sign, MonoTime now) {
    if (sign) send_voice_sign(of, *sign, now);
  };
  port_.subscribe<VoiceState>(
      {Where::kCapture, guest},
      [this, send](const Channel& channel, const VoiceState& state, MonoTime now) {
        send(channel.guest(), voice_signs_.on_state(channel.guest(), state, now), now);
      });
  port_.subscribe<Voice>({Where::kCapture, guest}, [this, send](const Channel& channel,
                                                                const Voice& voice, MonoTime now) {
    send(channel.guest(), voice_signs_.on_voice(channel.guest(), voice, now), now);
  });
}

void LinkBus::send_voice_sign(const GuestId& guest, std::uint8_t sign, MonoTime now) {
  const OwnName name(kSpeechPrefix, guest);
  link_->send_channel(name.view(), {&sign, 1}, now, guest);
}

void LinkBus::on_voice_sign(const GuestId& guest, wire::Bytes message, MonoTime now) {
  auto state = message.size() == 1 ? VoiceSigns::parse(message[0]) : std::nullopt;
  if (!state) return;
  state->time = now;
  state->clock_id = clock_id_;
  std::get<std::optional<VoiceState>>(known_[guest].states) = *state;
  port_.publish(Where::kGuest, guest, *state);
}

void LinkBus::keep_own_profile(const GuestId& guest, const Profile& profile, MonoTime now) {
  if (own_profiles_.size() >= wire::kMaxGuestsPerLink && !own_profiles_.contains(guest)) return;
  own_profiles_[guest] = profile;
  send_profile(guest, profile, now);
}

// The link sends changes only.
void LinkBus::send_profile(const GuestId& guest, Profile profile, MonoTime now) {
  profile.is_host = link_->core().may_remove();
  ProfileBytes bytes;
  const std::size_t size = write_profile(profile, bytes);
  const OwnName name(kProfilePrefix, guest);
  link_->send_channel(name.view(), {bytes.data(), size}, now, guest);
}

// The server grants the host's right only after the session has begun, so it is checked again each
// second. A host without a profile gets one that holds the host sign alone.
void LinkBus::send_profiles(MonoTime now) {
  if (link_->core().may_remove())
    for (const LocalGuestStats& own : link_->local_stats()) own_profiles_[own.guest];
  for (const auto& [guest, profile] : own_profiles_) send_profile(guest, profile, now);
}

void LinkBus::on_profile(const GuestId& guest, wire::Bytes message, MonoTime now) {
  auto profile = parse_profile(message);
  if (!profile) return;
  profile->time = now;
  profile->clock_id = clock_id_;
  std::get<std::optional<Profile>>(known_[guest].states) = *profile;
  port_.publish(Where::kGuest, guest, *profile);
}

// Its time is that of its arrival: a face is shown as it comes.
void LinkBus::on_face(const GuestId& guest, wire::Bytes message, MonoTime now) {
  Face face;
  if (!decode_face(message, face)) return;
  face.sequence = ++faces_heard_;
  face.clock_id = clock_id_;
  face.capture_time = now;
  port_.publish(Where::kGuest, guest, face);
}

void LinkBus::on_channel(const GuestId& guest, std::string_view name, ChannelClass kind,
                         wire::Bytes message) {
  const auto channel = name_of_guest(name, guest);
  if (kind == ChannelClass::kState) {
    auto& channels = known_[guest].channels;
    const std::string key(channel.view());
    // Changing names all the time fills no memory.
    if (channels.contains(key) || channels.size() < kMaxChannelsPerGuest)
      channels[key].assign(message.begin(), message.end());
  }
  bus_.publish_raw(channel.c_str(), message.data(), message.size());
}

template <class... Ts>
void LinkBus::send_each(const GuestId& guest) {
  const auto send = [this](const Channel& channel, const auto& message, MonoTime now) {
    link_->send(channel.guest(), message, now);
  };
  (port_.subscribe<Ts>({Where::kCapture, guest}, send), ...);
}

void LinkBus::send_signals_of(const GuestId& guest) {
  captures_.subscribe(guest, [this](const Channel& channel, const Pose& pose, MonoTime now) {
    link_->send(channel.guest(), pose, now);
  });
  port_.subscribe<TimedSkeleton>(
      {Where::kCapture, guest},
      [this](const Channel& channel, const TimedSkeleton& timed, MonoTime now) {
        link_->send(channel.guest(), timed.skeleton, now);
      });
  if (avatars_ != nullptr)
    port_.subscribe<AvatarFile>(
        {Where::kCapture, guest},
        [this](const Channel& channel, const AvatarFile& file, MonoTime now) {
          avatars_->choose(channel.guest(), file, now);
        });
  port_.subscribe<Face>({Where::kCapture, guest},
                        [this](const Channel& channel, const Face& face, MonoTime now) {
                          send_face(channel.guest(), face, now);
                        });
  port_.subscribe<Profile>({Where::kCapture, guest},
                           [this](const Channel& channel, const Profile& profile, MonoTime now) {
                             keep_own_profile(channel.guest(), profile, now);
                           });
  send_voice_signs_of(guest);
  send_each<Hands, Voice, Music, RoomSong, Scene, Avatar, Style, Placement, Chat>(guest);
}

void LinkBus::send_channels(const std::vector<ChannelRule>& rules) {
  rules_ = rules;
  for (const ChannelRule& rule : rules_) {
    if (!rule.is_out || is_own_channel(rule.pattern.text())) continue;
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

void LinkBus::follow_hearing(const Hearing& own) {
  own_hearing_ = own;
  port_.subscribe<HearingWish>(Where::kLocal,
                               [this](const Channel&, const HearingWish& wish, MonoTime now) {
                                 wishes_.hear(wish, now);
                                 tell_wishes(now);
                               });
}

void LinkBus::follow_interest(const Interest& own) {
  own_interest_ = own;
  port_.subscribe<InterestWish>(Where::kLocal,
                                [this](const Channel&, const InterestWish& wish, MonoTime now) {
                                  hidden_.hear(wish, now);
                                  tell_wishes(now);
                                });
}

void LinkBus::tell_wishes(MonoTime now) {
  const Hearing hearing = wishes_.within(own_hearing_);
  link_->set_hearing(hearing, now);
  if (!own_interest_) return;
  // Where nothing plays voices none is wanted for the sake of whom it belongs to.
  const Hearing played = wishes_.is_any() ? hearing : Hearing{false, {}};
  link_->set_interest(hidden_.within(*own_interest_, played), now);
}

void LinkBus::tell_status(LinkHandlers& handlers) {
  status_.listen_to(handlers);
  status_.on_change([this] { publish_status(mono_now()); });
}

void LinkBus::publish_status(MonoTime now) {
  status_.set_may_remove(link_ != nullptr && link_->core().may_remove());
  HouseLink status = status_.status();
  // Silence afterwards is the end that the server has announced.
  const bool is_unexplained = status.trouble == HouseLinkTrouble::kNone ||
                              status.trouble == HouseLinkTrouble::kNoAnswer ||
                              status.trouble == HouseLinkTrouble::kInterrupted;
  if (status.state == HouseLinkState::kLapsed && is_unexplained && link_ != nullptr &&
      link_->core().has_goodbye())
    status.trouble = HouseLinkTrouble::kClosed;
  status.time = now;
  status.clock_id = clock_id_;
  port_.publish(Channel::of_house(Signal::kHouseLink), status);
}

void LinkBus::follow_removals() {
  port_.subscribe<Removal>(Where::kLocal, [this](const Channel&, const Removal& removal, MonoTime) {
    if (link_ != nullptr) link_->ask_removal(removal.guest, removal.number);
  });
}

void LinkBus::forget(const GuestId& guest) {
  known_.erase(guest);
  if (avatars_ != nullptr) avatars_->forget(guest);
}

void LinkBus::publish_traffic(MonoTime now) {
  for (const RemoteGuestStats& guest : link_->remote_stats()) {
    if (!guest.is_here) continue;
    const auto count = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
    GuestTraffic traffic;
    traffic.time = now;
    traffic.clock_id = clock_id_;
    traffic.bytes = count(guest.bytes);
    traffic.received = count(guest.received);
    traffic.lost = count(guest.lost);
    traffic.late = count(guest.late);
    traffic.duplicate = count(guest.duplicate);
    traffic.invalid = count(guest.invalid);
    traffic.reference_missing = count(guest.reference_missing);
    traffic.key_frames_asked = count(guest.intra_frames_asked);
    port_.publish(Where::kGuest, guest.guest, traffic);
  }
}

void LinkBus::publish_second(MonoTime now) {
  for (auto& [guest, known] : known_) {
    const auto publish = [&, &of = guest](auto& state) {
      if (!state) return;
      if constexpr (requires { state->time; })
        state->time = now;
      else
        state->capture_time = now;
      port_.publish(Where::kGuest, of, *state);
    };
    std::apply([&](auto&... states) { (publish(states), ...); }, known.states);
    for (const auto& [name, message] : known.channels)
      bus_.publish_raw(name.c_str(), message.data(), message.size());
  }
  if (scene_) {
    scene_->second.time = now;
    port_.publish(Where::kRoom, scene_->first, scene_->second);
  }
  if (link_ == nullptr) return;
  voice_signs_.expire(now, [this, now](const GuestId& guest, std::uint8_t sign) {
    send_voice_sign(guest, sign, now);
  });
  send_profiles(now);
  const bool has_hearing_expired = wishes_.expire(now), has_hiding_expired = hidden_.expire(now);
  if (has_hearing_expired || has_hiding_expired) tell_wishes(now);
  publish_traffic(now);
  // As the clocks stand now, which is better than when it came.
  if (const auto music = link_->room_music(now))
    port_.publish(Where::kRoom, link_->room_setter(wire::StateKind::kMusic), *music);
  if (const auto song = link_->room_song(now))
    port_.publish(Where::kRoom, link_->room_setter(wire::StateKind::kSong), *song);
  port_.publish(Channel::of_program(Signal::kStats, "link"), link_->stats(now));
  publish_status(now);
}

}  // namespace dance
