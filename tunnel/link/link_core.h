// A house's link as a state machine: poses of this house in, datagrams to the server out; datagrams
// of the server in, poses of the others out, in this house's clock. Finds the server again by
// itself whatever happens to either side. It sends nothing without a DTLS session: SealClient tells
// it when there is one. Its parts are in core/ (the session, who is here) and signals/ (interest,
// poses, voices, states, channels, files); this class dispatches to them, and makes guests as they
// first send.
//
// Units/frames: now and received are MonoTime of this house's clock.
// Ownership:    owns codecs and tables; the sink must outlive it. Sending and receiving poses never
//               allocates once a guest is known.
// Threads:      none inside; one owner.
// Failure:      what cannot be sent or does not decode is dropped and counted, never queued.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/bus/messages.h"
#include "tunnel/link/core/link_context.h"
#include "tunnel/link/core/link_roster.h"
#include "tunnel/link/core/link_session.h"
#include "tunnel/link/signals/link_files.h"
#include "tunnel/link/signals/link_interest.h"
#include "tunnel/link/signals/link_receiver.h"
#include "tunnel/link/signals/link_removals.h"
#include "tunnel/link/signals/link_states.h"
#include "tunnel/link/signals/link_voice.h"

namespace dance {

class LinkCore {
 public:
  LinkCore(const LinkOptions& options, LinkHandlers handlers, DatagramSink& sink);
  LinkCore(const LinkCore&) = delete;
  LinkCore& operator=(const LinkCore&) = delete;

  // A sealed session has begun, or begun anew: says hello at once.
  void on_sealed(MonoTime now) { session_.on_sealed(now); }
  // The sealed session is gone: nothing is sent until the next one.
  void on_unsealed(MonoTime now) { session_.on_unsealed(now); }
  // Datagrams go out from another address from now on: says so at once.
  void on_moved(MonoTime now) { session_.on_moved(now); }
  void receive(wire::Bytes datagram, MonoTime received, MonoTime now);
  // Does what is due and returns when to call again; MonoTime() = not before it is sealed.
  MonoTime tick(MonoTime now);
  // When tick() is due: earlier than it said, after a guest was added or the server began anew.
  MonoTime next_deadline() const;

  void send(const GuestId& guest, const Pose& pose, MonoTime now);
  void send(const GuestId& guest, const Hands& hands, MonoTime now);
  void send(const GuestId& guest, const Skeleton& skeleton, MonoTime now);
  // At the end of the turn: tick() is due then.
  void send(const GuestId& guest, const Voice& voice, MonoTime now);
  // States of a guest of this house: told until the server has them.
  void send(const GuestId& guest, const Avatar& avatar, MonoTime now);
  void send(const GuestId& guest, const AvatarFile& file, MonoTime now);
  void send(const GuestId& guest, const Style& style, MonoTime now);
  void send(const GuestId& guest, const Placement& placement, MonoTime now);
  // A line or sign, as often as the guest's budget allows.
  void send(const GuestId& guest, const Chat& chat, MonoTime now);
  // What a guest of this house wants for the room: what holds comes through the handlers.
  void send(const GuestId& guest, const Music& music, MonoTime now);
  void send(const GuestId& guest, const RoomSong& song, MonoTime now);
  void send(const GuestId& guest, const Scene& scene, MonoTime now);
  // A message of a further channel, where a rule of the options lets it out.
  // Whose channel it is; where that is not set, the rule or the house's first guest decides.
  void send_channel(std::string_view name, wire::Bytes message, MonoTime now,
                    const GuestId& guest = GuestId());
  // Whom the server is to send, and how often: told until it is acknowledged. For guests who are
  // not here, it counts when they come.
  void set_interest(const Interest& interest, MonoTime now);
  // Whose voices it is to send.
  void set_hearing(const Hearing& hearing, MonoTime now);
  // A guest whom this house, a host, wants removed from the room. What becomes of it is told.
  void ask_removal(const GuestId& guest, std::int32_t number) { removals_.ask(guest, number); }
  bool may_remove() const { return link_.is_connected() && link_.may_remove; }
  // Files of avatars: tunnel/link/signals/link_files.h.
  LinkFiles& files() { return files_; }
  const LinkFiles& files() const { return files_; }
  void send_goodbye() { session_.send_goodbye(); }

  LinkState state() const { return link_.state; }
  bool is_connected() const { return link_.is_connected(); }
  // Hellos since the last sign of the server, those that come quickly not counted: many, and
  // another socket may be worth a try.
  int unanswered_hellos() const { return session_.unanswered_hellos(); }
  bool has_goodbye() const { return session_.has_goodbye(); }
  bool is_removed(MonoTime now) const { return now < session_.removed_until(); }
  MonoTime removed_until() const { return session_.removed_until(); }
  const LinkCounters& counters() const { return link_.counters; }
  const ClockMapper& clock() const { return link_.clock; }
  // The room's music and song in this house's clock, as it is mapped now.
  std::optional<Music> room_music(MonoTime now) const { return room_.music(now); }
  std::optional<RoomSong> room_song(MonoTime now) const { return room_.song(now); }
  const GuestId& room_setter(wire::StateKind kind) const { return room_.setter(kind); }
  void fill(Stats& stats) const;
  // Those who are here, and the last that have left.
  std::vector<RemoteGuestStats> remote_stats() const { return link_.remotes.stats(); }
  std::vector<LocalGuestStats> local_stats() const { return link_.locals.stats(); }
  const PathStats& path() const { return link_.path; }

 private:
  LocalGuest* find_or_add(const GuestId& id, MonoTime now);
  LocalGuest* find_or_add_dancer(const GuestId& id, MonoTime now);
  bool on_welcome(wire::Bytes body, MonoTime received, MonoTime now);
  bool on_refusal(wire::Bytes body, MonoTime now);
  bool on_servers(wire::Bytes body, MonoTime now);
  void begin_session();
  bool on_session_datagram(const wire::Opening& opening, MonoTime received, MonoTime now);
  void send_ping(MonoTime now);

  LinkContext link_;
  LinkSession session_{link_};
  LinkRoster roster_{link_};
  LinkSender sender_{link_};
  LinkChannels channels_{link_, sender_};
  LinkReceiver receiver_{link_, sender_, channels_};
  LinkRoom room_{link_};
  LinkChat chat_{link_};
  LinkStates states_{link_, room_, channels_, chat_};
  LinkFiles files_{link_};
  LinkVoice voice_{link_, sender_};
  LinkInterest interest_{link_};
  LinkRemovals removals_{link_};
};

}  // namespace dance
