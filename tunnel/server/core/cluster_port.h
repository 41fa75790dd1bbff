// What a server tells the other servers of its cluster about its own guests, and about what its
// links have of theirs: the seam between the server's state machine and what joins servers. The
// other way goes through ServerRemotes.
//
// Units/frames: times are of the session clock, which all servers of a cluster share.
// Ownership:    what is passed is valid during the call.
// Threads:      the caller's.
// Failure:      none here; what does not reach another server is its link's loss.
#pragma once

#include <cstdint>
#include <variant>

#include "tunnel/session/reference_control.h"
#include "tunnel/wire/wire_files.h"
#include "tunnel/wire/wire_state.h"
#include "tunnel/wire/wire_voice.h"

namespace dance {

struct ServerGuest;
struct ServerRoom;
struct RemovalNotice;

// One server process, from its start to its end; random, never 0.
using ServerId = std::uint64_t;

// From one server to another, about the path to its links in one room.
struct PathFeedback {
  bool has_receiver = false;
  std::uint16_t loss = 0;        // to the worst receiver, in 1/65,536
  std::uint16_t in_a_row = 0;    // of that what is lost together with the datagram before
  std::uint16_t round_trip = 0;  // to the worst receiver and back, in 0.1 ms
  bool operator==(const PathFeedback&) const = default;
};

// From one server to another, about one guest of the other's.
struct RemoteFeedback {
  std::uint8_t intra_frames = 0;  // counts intra frames asked for; a change asks for one
  PathFeedback path;
  CommonFrames frames;  // their streams without the guest's generation
};

// What servers tell each other about the file of a guest's avatar. The slot in its name is that of
// the server that holds it: servers name the guest.
using FilePart = std::variant<wire::FileWant, wire::FileChunk, wire::FileRefusal>;

class ClusterPort {
 public:
  virtual ~ClusterPort() = default;

  // A room has its first link here, or has lost its last.
  virtual void on_room_opened(const ServerRoom& room) = 0;
  virtual void on_room_closed(const ServerRoom& room) = 0;
  // It has a link here with a host's key now, or none any more.
  virtual void on_hosts_changed(const ServerRoom& room) = 0;
  // A guest came through a link of this server's, or has left it.
  virtual void on_guest_came(const ServerRoom& room, const ServerGuest& guest) = 0;
  virtual void on_guest_left(const ServerRoom& room, const ServerGuest& guest) = 0;
  // Whether any link here wants to hear a guest of another server.
  virtual void on_wanted(const ServerRoom& room, const ServerGuest& guest, bool is_wanted) = 0;
  // Of a guest of this server's, in a room where others have links.
  virtual void on_record(const ServerRoom& room, const ServerGuest& guest,
                         const wire::Record& record) = 0;
  // As on_record(), of 10 ms of the guest's voice.
  virtual void on_voice(const ServerRoom& room, const ServerGuest& guest,
                        const wire::VoiceRecord& record) = 0;
  // A state of a guest of this server's, or of the room, set here.
  virtual void on_state(const ServerRoom& room, const ServerGuest* guest,
                        const wire::State& state) = 0;
  // For the server `to`, about its guest.
  virtual void on_feedback(ServerId to, const ServerRoom& room, const ServerGuest& guest,
                           const RemoteFeedback& feedback) = 0;
  // For the server `to`: of its guest's file what is wanted, or of this one's guest a part of it.
  virtual void on_file(ServerId to, const ServerRoom& room, const ServerGuest& guest,
                       const FilePart& part) = 0;
  // A guest is to be removed from a room, or was: for all servers.
  virtual void on_removal(const wire::RoomName& room, const RemovalNotice& notice) = 0;
  // Whether nothing waits on the way to other servers: files go only then.
  virtual bool is_clear() const = 0;
};

}  // namespace dance
