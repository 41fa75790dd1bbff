// One server's part in a cluster: tells the others what its links bring, and takes from them what
// theirs bring. A room lives wherever one of its links is. Poses and feedback go by messages;
// which servers a room is on, who is in it, and its states are values that last, so that a server
// that dies loses none of them.
//
// Units/frames: now is this process's MonoTime; the server's state machine gets session time.
// Ownership:    bus and server must outlive it.
// Threads:      the owner's; no call waits.
// Failure:      what other servers say wrongly is counted; a server that falls silent is taken for
//               dead, and its guests leave unless they come back through another.
#pragma once

#include <array>
#include <map>
#include <set>
#include <vector>

#include "tunnel/cluster/cluster_bus.h"
#include "tunnel/cluster/cluster_format.h"
#include "tunnel/cluster/cluster_names.h"
#include "tunnel/cluster/cluster_peers.h"
#include "tunnel/cluster/cluster_sender.h"
#include "tunnel/server/server_core.h"

namespace dance {

class ClusterNode final : public ClusterPort {
 public:
  struct Options {
    ServerId id = 0;           // random
    std::int64_t born_us = 0;  // wall clock at the process's start
    Address address;           // as guests reach this server
  };
  struct Counters {
    std::uint64_t messages_in = 0;
    std::uint64_t messages_out = 0;
    std::uint64_t bytes_in = 0;  // of messages, without NATS's own
    std::uint64_t bytes_out = 0;
    std::uint64_t records_in = 0;
    std::uint64_t records_out = 0;  // once each, however many servers take it
    std::uint64_t voices_in = 0;
    std::uint64_t voices_out = 0;  // once each, as records
    std::uint64_t values_in = 0;
    std::uint64_t malformed = 0;
    std::uint64_t other_codecs = 0;  // guests whose room speaks another codec here
  };

  ClusterNode(const Options& options, ClusterBus& bus);

  // Before the server has links; it joins this node.
  void attach(ServerCore& server);
  // Whether it is known whose clock is the cluster's, and what that shows. Links may come then.
  bool is_settled(MonoTime now) const;
  const SessionClock& clock() const { return peers_.clock(); }

  // What has gathered for other servers. Call after each turn of the server.
  void end_turn(MonoTime now);
  // Heartbeats, clocks, timeouts of peers; returns when to call again.
  MonoTime tick(MonoTime now);
  // The server ends: its guests may come back through another at once.
  void leave();

  const ClusterPeers& peers() const { return peers_; }
  Counters counters() const;
  ServerId id() const { return options_.id; }
  const Address& address() const { return options_.address; }

  // ClusterPort, called by the server.
  void on_room_opened(const ServerRoom& room) override;
  void on_room_closed(const ServerRoom& room) override;
  void on_hosts_changed(const ServerRoom& room) override;
  void on_guest_came(const ServerRoom& room, const ServerGuest& guest) override;
  void on_guest_left(const ServerRoom& room, const ServerGuest& guest) override;
  void on_wanted(const ServerRoom& room, const ServerGuest& guest, bool is_wanted) override;
  void on_record(const ServerRoom& room, const ServerGuest& guest,
                 const wire::Record& record) override;
  void on_voice(const ServerRoom& room, const ServerGuest& guest,
                const wire::VoiceRecord& record) override;
  void on_state(const ServerRoom& room, const ServerGuest* guest,
                const wire::State& state) override;
  void on_feedback(ServerId to, const ServerRoom& room, const ServerGuest& guest,
                   const RemoteFeedback& feedback) override;
  void on_file(ServerId to, const ServerRoom& room, const ServerGuest& guest,
               const FilePart& part) override;
  void on_removal(const wire::RoomName& room, const RemovalNotice& notice) override;
  bool is_clear() const override { return bus_.is_clear(); }

 private:
  // What the lasting values say of a room with links here.
  struct Room {
    CodecName codec;
    bool has_presence = false;             // this server's own has been read
    std::map<ServerId, MonoTime> present;  // since when it is known; other servers
    std::map<GuestId, cluster::GuestValue> guests;
    std::set<GuestId> subscribed;  // whose poses come here
    bool has_host = false;         // a link of this server has a host's key
    bool lacks_places = false;     // somebody may not be shown here: the room was full, say
    std::map<std::pair<GuestId, std::size_t>, std::vector<std::uint8_t>> states;  // guest not set:
                                                                                  // the room's
  };
  struct Pending {
    ServerId to = 0;
    cluster::FeedbackMessage message;
  };

  void on_message(std::string_view subject, cluster::Bytes bytes, MonoTime now);
  void take(std::string_view subject, cluster::Bytes bytes, MonoTime now);
  void on_value(std::string_view key, std::optional<cluster::Bytes> bytes, MonoTime now);
  void on_all_read(std::string_view key);
  void on_back(MonoTime now);
  void take(const cluster::Heartbeat& beat, MonoTime now);
  void take(const cluster::ClockQuestion& question, MonoTime now);
  template <class Told>
  void take_record(const Told& told, const std::optional<cluster::PoseSubject>& of, MonoTime now);
  void take(const cluster::FeedbackMessage& message, MonoTime now);
  void take(const cluster::FileMessage& message, MonoTime now);
  void take(const cluster::RemovalMessage& message, MonoTime now);
  void take_presence(Room& room, const cluster::Key& key, const cluster::PresenceValue* value,
                     MonoTime now);
  void take_guest(Room& room, const cluster::Key& key, const cluster::GuestValue* value,
                  MonoTime now);
  bool place(const wire::RoomName& room, const GuestId& guest, const cluster::GuestValue& value,
             MonoTime now);
  void take_state(Room& room, const cluster::Key& key, std::optional<cluster::Bytes> bytes);
  void apply_states(const Room& room, const wire::RoomName& name, const GuestId& guest);
  void apply_state(const Room& room, const wire::RoomName& name, const GuestId& guest,
                   std::size_t place, cluster::Bytes bytes);
  bool is_ours(const Room& room, const GuestId& guest) const;
  bool is_better(const cluster::GuestValue& fresh, const cluster::GuestValue& known,
                 MonoTime now) const;
  void beat(bool is_leaving);
  void forget_silent(MonoTime now);
  void expect_all(const Room& room, MonoTime now);
  void place_all(MonoTime now);
  void write_all();
  void write_after_healing(MonoTime now);
  void forget(ServerId server);
  bool is_first_alive(const Room& room) const;
  void put(const cluster::Key& key, const cluster::Value& value);
  void erase(const cluster::Key& key);
  void put_presence(const wire::RoomName& room);
  void put_guest(const wire::RoomName& room, const GuestId& guest);
  void flush(Pending& pending);

  Options options_;
  ClusterBus& bus_;
  ServerCore* server_ = nullptr;
  ClusterPeers peers_;
  std::map<wire::RoomName, Room> rooms_;
  std::vector<Pending> pending_;
  cluster::ClusterSender sender_;
  MonoTime now_;  // of the newest call that said so
  MonoTime begun_;
  MonoTime next_beat_;
  MonoTime next_writing_;
  int writes_after_healing_ = 0;
  Counters counters_;
  std::array<std::uint8_t, cluster::kMaxBytes> buffer_;
};

}  // namespace dance
