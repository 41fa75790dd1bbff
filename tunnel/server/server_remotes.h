// The other servers of a cluster, as a room here knows them: each is a session whose guests came
// through its own links. What it tells of them is taken like what links tell, and forwarded to the
// links of this server only.
//
// Units/frames: MonoTime of the session clock; rooms and guests by name.
// Ownership:    refers to the server's context and parts. Records and feedback never allocate.
// Threads:      none inside; one owner.
// Failure:      what is told of a room without links here, or of a guest of another server, does
//               nothing; guests without a place are counted.
#pragma once

#include "tunnel/server/server_admission.h"
#include "tunnel/server/signals/server_files.h"
#include "tunnel/server/signals/server_forwarder.h"
#include "tunnel/server/signals/server_voice.h"

namespace dance {

class ServerRemotes {
 public:
  struct Counters {
    std::uint64_t guests_without_place = 0;  // the room is full here, or their key has its share
    std::uint64_t servers_without_place = 0;
    std::uint64_t unknown = 0;  // records and feedback of guests or rooms that are not here
  };

  ServerRemotes(ServerContext& server, ServerSlots& slots, ServerAdmission& admission,
                ServerForwarder& forwarder, ServerFeedback& feedback, ServerStates& states,
                ServerFiles& files, ServerVoice& voice)
      : server_(server),
        slots_(slots),
        admission_(admission),
        forwarder_(forwarder),
        feedback_(feedback),
        states_(states),
        files_(files),
        voice_(voice) {}

  // All is told of who is in the room at other servers.
  void settle(const wire::RoomName& room);
  // Another server has links in a room, also with a host's key; or has none any more.
  void open(const wire::RoomName& room, ServerId server, bool has_host, MonoTime now);
  void close(const wire::RoomName& room, ServerId server);
  // It lives, and this is how far it is.
  void note_alive(ServerId server, Duration round_trip, MonoTime now);

  // A guest came through it, from wherever; the link's token says whether it was here before. Its
  // last link here may end with that, and so the room. False where there is no place for it.
  bool set_guest(const wire::RoomName& room, ServerId server, const GuestId& guest,
                 std::uint64_t link_token, const OwnerKey& key, MonoTime now);
  // Nothing where it came through another server meanwhile.
  void remove_guest(const wire::RoomName& room, ServerId server, const GuestId& guest);
  void on_record(const wire::RoomName& room, ServerId server, const GuestId& guest,
                 std::uint64_t link_token, wire::Record record, MonoTime now);
  void on_record(const wire::RoomName& room, ServerId server, const GuestId& guest,
                 std::uint64_t link_token, wire::VoiceRecord record, MonoTime now);
  void on_feedback(const wire::RoomName& room, ServerId server, const GuestId& guest,
                   const RemoteFeedback& feedback, MonoTime now);
  // Of a file: what that server wants of a guest of this one, or what came of its own guest's.
  void on_file(const wire::RoomName& room, ServerId server, const GuestId& guest,
               const FilePart& part, MonoTime now);
  // Of a guest of that server's, or of the room (guest not set).
  void on_state(const wire::RoomName& room, const GuestId& guest, const wire::State& state);

  // What was said may be lost.
  void repeat_feedback(MonoTime now);
  const Counters& counters() const { return counters_; }

 private:
  ServerRoom* find(const wire::RoomName& room);
  // The session of a server in a room, and its guest's slot; nothing where it has no such guest.
  struct Place {
    std::size_t session = 0;
    std::uint8_t slot = 0;
  };
  std::optional<Place> place_of(const wire::RoomName& room, ServerId server, const GuestId& guest,
                                std::uint64_t link_token);
  bool has_places_for(const ServerRoom& room, const OwnerKey& key) const;
  std::optional<std::size_t> session_of(const ServerRoom& room, ServerId server) const;

  ServerContext& server_;
  ServerSlots& slots_;
  ServerAdmission& admission_;
  ServerForwarder& forwarder_;
  ServerFeedback& feedback_;
  ServerStates& states_;
  ServerFiles& files_;
  ServerVoice& voice_;
  Counters counters_;
};

}  // namespace dance
