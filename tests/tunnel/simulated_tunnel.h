// A server, houses and the lines between them without sockets and without waiting: time passes when
// the test says so, each house has a clock of its own, and lines can be slow or cut. Sealed
// sessions are only played: a house has one at once when it begins, and a new one when the server
// does not know the one it had.
//
// Units/frames: now() is the server's clock; a house's clock is now() + its clock_ahead.
// Ownership:    owns everything.
// Threads:      none.
// Failure:      none.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/tunnel/session/refused_state.h"
#include "tunnel/link/link_core.h"
#include "tunnel/server/server_core.h"

namespace dance {

inline GuestId guest(std::string_view name) { return *GuestId::parse(name); }

// A pose that tells its number: hips and one arm depend on it.
inline Pose pose_number(std::uint32_t sequence, MonoTime capture, std::uint64_t clock_id) {
  Pose pose;
  const float angle = static_cast<float>(sequence % 600) * 0.01f;
  pose.R_PB[index_of(Bone::kLeftUpperArm)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()));
  pose.p_WH_m.x() = static_cast<float>(sequence % 1000) * 0.001f;
  pose.sequence = sequence;
  pose.capture_time = capture;
  pose.clock_id = clock_id;
  pose.stamp(Hop::kPublished, capture + Duration::ms(2));
  return pose;
}

class SimulatedTunnel {
 public:
  struct Heard {
    GuestId guest;
    Pose pose;
    MonoTime at;
  };
  struct House {
    PeerId peer = 0;  // its sealed session; 0 = none
    MonoTime seal_due;
    Access access{.any_name = true};
    std::uint64_t clock_id = 0;
    Duration clock_ahead;
    Duration up = Duration::ms(5);
    Duration down = Duration::ms(5);
    bool is_cut = false;
    std::unique_ptr<LinkCore> link;
    std::unique_ptr<DatagramSink> sink;
    std::vector<Heard> poses;
    std::vector<std::pair<GuestId, Hands>> hands;
    std::vector<std::pair<GuestId, Skeleton>> skeletons;
    struct HeardVoice {
      GuestId guest;
      Voice voice;
      MonoTime at;
    };
    std::vector<HeardVoice> voices;
    // The last of each guest; of the room who set it, and what.
    std::map<GuestId, Avatar> avatars;
    std::map<GuestId, AvatarFile> avatar_files;
    // Whole files, as they came; their hash is said to be right while files_are_right.
    std::map<GuestId, std::vector<std::uint8_t>> files;
    std::vector<std::pair<GuestId, wire::FileRefusalCause>> file_refusals;
    std::size_t file_blocks = 0;
    bool files_are_right = true;
    std::vector<std::pair<GuestId, Chat>> chats;
    std::map<GuestId, Style> styles;
    std::map<GuestId, Placement> placements;
    std::optional<std::pair<GuestId, Music>> music;
    std::optional<std::pair<GuestId, RoomSong>> song;
    std::optional<std::pair<GuestId, Scene>> scene;
    std::vector<std::string> refused;  // "music overruled", "scene not allowed"
    struct ChannelMessage {
      GuestId guest;
      std::string name;
      std::vector<std::uint8_t> bytes;
      MonoTime at;
    };
    std::vector<ChannelMessage> channels;
    std::vector<std::string> events;  // "+bob", "-bob", "connected", "lapsed", "refused …"
    std::uint32_t next_sequence = 1;
    bool is_running = true;

    bool saw(const std::string& event) const {
      return std::find(events.begin(), events.end(), event) != events.end();
    }
    std::size_t heard_of(const GuestId& id) const {
      return static_cast<std::size_t>(std::count_if(
          poses.begin(), poses.end(), [&](const Heard& heard) { return heard.guest == id; }));
    }
  };

  explicit SimulatedTunnel(const ServerLimits& limits = {}, std::uint64_t seed = 20'260'101)
      : limits_(limits), random_(seed) {
    start_server();
  }

  void start_server() {
    server_ = std::make_unique<ServerCore>(
        limits_, [this] { return random_.next_u64(); }, server_sink_);
  }
  void stop_server() {
    server_.reset();
    peers_.clear();
  }
  ServerCore& server() { return *server_; }

  House& add_house(const std::string& room, const std::vector<std::string>& guests,
                   Duration clock_ahead = {}, const Access& access = {.any_name = true}) {
    houses_.push_back(std::make_unique<House>());
    House& house = *houses_.back();
    const auto number = static_cast<std::uint16_t>(houses_.size());
    house.clock_id = 100u + number;
    house.clock_ahead = clock_ahead;
    house.access = access;
    start_link(house, room, guests);
    return house;
  }
  void change_access(const House& house) { peers_.at(house.peer) = house.access; }

  // A new process in the same house: another token, nothing remembered.
  void start_link(House& house, const std::string& room, const std::vector<std::string>& guests) {
    LinkOptions options = link_options;
    options.room = guest(room);
    for (const auto& name : guests)
      if (!options.guests.try_push(guest(name))) std::abort();
    options.token = random_.next_u64() | 1;
    options.clock_id = house.clock_id;
    options.seed = random_.next_u64();
    house.sink = std::make_unique<LinkSink>(*this, house);
    house.link = std::make_unique<LinkCore>(options, handlers_of(house), *house.sink);
    house.is_running = true;
    seal_anew(house);
  }

  // The house's next sealed session, from now on. What is under way to the one before is lost.
  void seal_anew(House& house) {
    house.peer = 0;
    house.seal_due = now_;
  }

  // The house goes over to this tunnel's server, as after that server's end.
  void adopt(SimulatedTunnel& from, House& house) {
    const auto at = std::find_if(from.houses_.begin(), from.houses_.end(),
                                 [&](const auto& it) { return it.get() == &house; });
    houses_.push_back(std::move(*at));
    from.houses_.erase(at);
    static_cast<LinkSink&>(*house.sink).tunnel = this;
    house.peer = 0;
    house.link->on_unsealed(time_in(house));
    house.seal_due = now_ + house.down;
  }

  bool has(const House& house) const {
    return std::any_of(houses_.begin(), houses_.end(),
                       [&](const auto& it) { return it.get() == &house; });
  }

  MonoTime now() const { return now_; }
  MonoTime time_in(const House& house) const { return now_ + house.clock_ahead; }

  // Everything that happens in the next `duration`, in steps of a millisecond.
  void run(Duration duration, const std::function<void()>& each_ms = {}) {
    const MonoTime end = now_ + duration;
    while (now_ < end) {
      now_ += Duration::ms(1);
      deliver_due();
      for (auto& house : houses_) {
        if (!house->is_running) continue;
        seal_if_due(*house);
        const MonoTime due = house->link->next_deadline();
        if (due.is_set() && due <= time_in(*house)) house->link->tick(time_in(*house));
      }
      if (server_) server_->tick(now_);
      if (each_ms) each_ms();
    }
  }

  void dance(House& house, const GuestId& who) {
    house.link->send(
        who, pose_number(house.next_sequence++, time_in(house) - Duration::ms(10), house.clock_id),
        time_in(house));
  }

  // A peer without a house, whose datagrams a test makes.
  PeerId add_peer(const Access& access = {.any_name = true}) {
    peers_[++newest_peer_] = access;
    return newest_peer_;
  }

  // Straight into the server, as if `from` had sent it.
  void inject(PeerId from, wire::Bytes bytes) {
    server_->receive(from, peers_.at(from), bytes, now_, now_);
    server_->end_turn(now_);
  }

  // What links begin with; room, guests, token, clock and seed are filled in.
  LinkOptions link_options;

  // The test's eye on what passes: return false to lose it.
  std::function<bool(bool to_server, PeerId peer, wire::Bytes bytes)> on_datagram;

 private:
  struct Parcel {
    MonoTime due;
    bool to_server;
    PeerId peer;
    std::vector<std::uint8_t> bytes;
  };
  class ServerSink final : public PeerSink {
   public:
    explicit ServerSink(SimulatedTunnel& tunnel) : tunnel_(tunnel) {}
    void send(PeerId to, std::span<const std::uint8_t> bytes) override {
      tunnel_.post(false, to, bytes);
    }

   private:
    SimulatedTunnel& tunnel_;
  };
  class LinkSink final : public DatagramSink {
   public:
    LinkSink(SimulatedTunnel& of, House& house) : tunnel(&of), house_(house) {}
    void send(const Address&, std::span<const std::uint8_t> bytes) override {
      tunnel->post(true, house_.peer, bytes);
    }
    SimulatedTunnel* tunnel;

   private:
    House& house_;
  };

  House* house_of(PeerId peer) {
    for (auto& house : houses_)
      if (house->peer == peer && peer != 0) return house.get();
    return nullptr;
  }

  void seal_if_due(House& house) {
    if (!house.seal_due.is_set() || house.seal_due > now_ || !server_ || house.is_cut) return;
    house.seal_due = MonoTime();
    house.peer = add_peer(house.access);
    house.link->on_sealed(time_in(house));
  }

  // The server began anew: the house hears so, and comes to another sealed session.
  void unseal(House& house) {
    house.peer = 0;
    house.link->on_unsealed(time_in(house));
    house.seal_due = now_ + house.down + house.up + house.down;
  }

  void post(bool to_server, PeerId peer, wire::Bytes bytes) {
    if (bytes.size() > wire::kMaxPlain) std::abort();
    House* house = house_of(peer);
    if (on_datagram && !on_datagram(to_server, peer, bytes)) return;
    if (house == nullptr || house->is_cut) return;
    parcels_.push_back({now_ + (to_server ? house->up : house->down),
                        to_server,
                        peer,
                        {bytes.begin(), bytes.end()}});
  }

  void deliver_due() {
    std::vector<Parcel> due;
    const auto later = std::stable_partition(parcels_.begin(), parcels_.end(),
                                             [&](const Parcel& p) { return p.due <= now_; });
    due.assign(std::make_move_iterator(parcels_.begin()), std::make_move_iterator(later));
    parcels_.erase(parcels_.begin(), later);
    for (const Parcel& parcel : due) {
      if (parcel.to_server) {
        const auto peer = peers_.find(parcel.peer);
        House* house = house_of(parcel.peer);
        if (server_ && peer != peers_.end())
          server_->receive(peer->first, peer->second, parcel.bytes, now_, now_);
        else if (server_ && house && house->is_running)
          unseal(*house);
      } else if (House* house = house_of(parcel.peer); house && house->is_running) {
        house->link->receive(parcel.bytes, time_in(*house), time_in(*house));
      }
    }
    if (server_) server_->end_turn(now_);
  }

  LinkHandlers handlers_of(House& house) {
    LinkHandlers handlers;
    handlers.on_pose = [&](const GuestId& id, const Pose& pose, MonoTime now) {
      house.poses.push_back({id, pose, now});
    };
    handlers.on_hands = [&](const GuestId& id, const Hands& hands, MonoTime) {
      house.hands.emplace_back(id, hands);
    };
    handlers.on_skeleton = [&](const GuestId& id, const Skeleton& skeleton, MonoTime) {
      house.skeletons.emplace_back(id, skeleton);
    };
    handlers.on_voice = [&](const GuestId& id, const Voice& voice, MonoTime now) {
      house.voices.push_back({id, voice, now});
    };
    add_state_handlers(house, handlers);
    handlers.on_guest_joined = [&](const GuestId& id, MonoTime) {
      house.events.push_back("+" + std::string(id.view()));
    };
    handlers.on_guest_left = [&](const GuestId& id, MonoTime) {
      house.events.push_back("-" + std::string(id.view()));
    };
    handlers.on_state = [&](LinkState state, MonoTime) {
      house.events.emplace_back(state == LinkState::kConnected ? "connected"
                                : state == LinkState::kLapsed  ? "lapsed"
                                                               : "connecting");
    };
    handlers.on_refused = [&](const wire::RefusalNotice& refusal, MonoTime) {
      house.events.push_back("refused " + std::to_string(static_cast<int>(refusal.cause)) + " " +
                             std::string(refusal.guest.view()));
    };
    handlers.on_removal = [&](std::int32_t number, RemovalVerdict verdict) {
      house.events.push_back("removal " + std::to_string(number) + " " +
                             std::to_string(static_cast<int>(verdict)));
    };
    return handlers;
  }

  static void add_state_handlers(House& house, LinkHandlers& handlers) {
    const auto keep_last = [](auto& states) {
      return [&states](const GuestId& id, const auto& value, MonoTime) { states[id] = value; };
    };
    handlers.on_avatar = keep_last(house.avatars);
    handlers.on_avatar_file = keep_last(house.avatar_files);
    handlers.on_chat = [&](const GuestId& id, const Chat& chat, MonoTime) {
      house.chats.emplace_back(id, chat);
    };
    handlers.on_file = [&](const GuestId& id, const FileHash& hash, ChunkedFile&& file) {
      auto& bytes = house.files[id];
      bytes.clear();
      for (std::size_t i = 0; i < file.blocks(); ++i)
        bytes.insert(bytes.end(), file.block(i).begin(), file.block(i).end());
      house.link->files().settle(id, hash,
                                 house.files_are_right ? FileVerdict::kRight : FileVerdict::kWrong);
    };
    handlers.on_file_block = [&](const GuestId&, const FileHash&, const ChunkedFile&, std::size_t) {
      ++house.file_blocks;
    };
    handlers.on_file_refused = [&](const GuestId& id, const FileHash&,
                                   wire::FileRefusalCause cause) {
      house.file_refusals.emplace_back(id, cause);
    };
    handlers.on_style = keep_last(house.styles);
    handlers.on_placement = keep_last(house.placements);
    const auto keep = [](auto& state) {
      return [&state](const GuestId& id, const auto& value, MonoTime) { state.emplace(id, value); };
    };
    handlers.on_music = keep(house.music);
    handlers.on_song = keep(house.song);
    handlers.on_scene = keep(house.scene);
    handlers.on_room_state_refused = [&](wire::StateKind kind, wire::StateVerdict verdict) {
      house.refused.push_back(refused_state(kind, verdict));
    };
    handlers.on_channel = [&](const GuestId& id, std::string_view name, ChannelClass,
                              wire::Bytes message, MonoTime now) {
      house.channels.push_back({id, std::string(name), {message.begin(), message.end()}, now});
    };
  }

  ServerLimits limits_;
  Random random_;
  MonoTime now_ = MonoTime::from_us(5'000'000'000);
  ServerSink server_sink_{*this};
  std::unique_ptr<ServerCore> server_;
  std::vector<std::unique_ptr<House>> houses_;
  std::vector<Parcel> parcels_;
  std::map<PeerId, Access> peers_;  // that the server has sealed sessions with
  PeerId newest_peer_ = 0;
};

// The dancers send a pose each, about 60 times a second.
struct Dance {
  static constexpr std::int64_t kFrame_ms = 16;
  SimulatedTunnel& tunnel;
  std::vector<std::pair<SimulatedTunnel::House*, GuestId>> dancers;
  void run(Duration duration) {
    tunnel.run(duration, [this] {
      if (tunnel.now().since_zero_us() / 1000 % kFrame_ms != 0) return;
      for (auto& [house, who] : dancers)
        if (house->is_running) tunnel.dance(*house, who);
    });
  }
};

}  // namespace dance
