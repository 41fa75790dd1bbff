#include <string>

#include "tunnel/link/core/link_options.h"

namespace dance {

std::string refusal_line(const wire::RefusalNotice& refusal, const wire::RoomName& room) {
  const std::string room_name(room.view());
  const std::string guest(refusal.guest.view());
  switch (refusal.cause) {
    case wire::Refusal::kVersion:
      return "the server speaks version " + std::to_string(refusal.server_version) +
             " of the wire format, this link version " + std::to_string(wire::kWireVersion) +
             ": update the older of the two";
    case wire::Refusal::kBadName:
      return std::string("the server does not take a name: ") + kGuestIdRule +
             ", and each may be named once; so is a room";
    case wire::Refusal::kNameTaken:
      return "guest '" + guest + "' is in room '" + room_name +
             "' already through another link: choose another --guest, or end the other link";
    case wire::Refusal::kRoomFull:
      return "room '" + room_name +
             "' is full: wait for somebody to leave, or choose another --room";
    case wire::Refusal::kListenersFull:
      return "room '" + room_name +
             "' has as many listeners as the server allows: wait for one to leave, or ask its "
             "keeper for more --max-listeners";
    case wire::Refusal::kOnlyListens:
      return "this house's key only listens: join without --guest (dance link: with "
             "--listen-only), or ask the server's keeper for a key that dances";
    case wire::Refusal::kServerFull:
      return "the server has no place for another link or room: try later, or start it with more "
             "--max-sessions or --max-rooms";
    case wire::Refusal::kKeySessions:
      return "this house's key is in use in as many places as the server allows: end another link "
             "with this key, or ask the server's keeper for a key of your own";
    case wire::Refusal::kKeyRooms:
      return "this house's key has opened as many rooms as the server allows: join a room that "
             "exists, or leave another one";
    case wire::Refusal::kKeyGuests:
      return "this house's key has as many places in room '" + room_name +
             "' as the server allows: bring fewer guests, end another link with this key, or ask "
             "the server's keeper for another key";
    case wire::Refusal::kCodec:
      return "room '" + room_name +
             "' speaks a pose codec that this link does not know: update this link";
    case wire::Refusal::kRemoved:
      return "a host has removed this house from room '" + room_name + "': it asks again in " +
             std::to_string((refusal.seconds + 59) / 60) + " minutes, and no earlier; ask the host";
    case wire::Refusal::kKeyExpired:
      return "this house's key has expired: ask the server's keeper for another invitation, and "
             "open it with: dance join LINK";
    case wire::Refusal::kNotAllowedRoom:
      return "this house's key does not open room '" + room_name +
             "': ask the server's keeper for a key to it, or choose the --room of your key";
    case wire::Refusal::kNotAllowedName:
      return "this house's key does not allow a guest '" + guest +
             "': ask the server's keeper for a key of that name, or choose the --guest of your "
             "key";
  }
  return "the server refused for a cause that this link does not know: update this link";
}

std::string room_state_line(wire::StateKind kind, wire::StateVerdict verdict) {
  const std::string what = kind == wire::StateKind::kMusic  ? "music"
                           : kind == wire::StateKind::kSong ? "song"
                                                            : "scene";
  if (verdict == wire::StateVerdict::kOverruled)
    return "somebody else has set the room's " + what + "; set another one to change it again";
  if (kind == wire::StateKind::kSong) return "a host has locked the room's song";
  return "this house may not set the room's " + what +
         ": a host is there, or this house only listens; ask the host";
}

std::string no_entry_line(SealTrouble trouble, const std::string& server) {
  switch (trouble) {
    case SealTrouble::kWrongKey:
      return "the server " + server +
             " does not know this house's key: ask its keeper for another invitation, and open it "
             "with: dance join LINK";
    case SealTrouble::kNotTrusted:
      return "the server " + server +
             " and this house cannot agree: one of the certificates is not signed by whom the "
             "other "
             "trusts, or the server takes keys only, or speaks another version";
    case SealTrouble::kServerKeyChanged:
      return "the server " + server +
             " has another key than the one that this house knows, so no dance was sent: another "
             "machine may have taken its place. If its keeper confirms a new key (dance server "
             "--list-keys prints it), run: dance key --trust " +
             server + "=KEY, and join again";
    case SealTrouble::kInterrupted:
      return "the server " + server +
             " answers, and then no more: is there a firewall on the way, or a line that loses "
             "nearly everything?";
    case SealTrouble::kNoAnswer:
      break;
  }
  return "the server " + server + " does not answer";
}

std::string no_answer_line(const Address& server) {
  return server.to_string() +
         " does not answer: is `dance server` running there, and its UDP port open? Trying on";
}

std::string other_server_line(const Address& server) {
  return "goes on through another server of the cluster, " + server.to_string();
}

std::string new_address_line(const std::string& server, const Address& address) {
  return server + " is at " + address.to_string() + " now: connecting there";
}

std::string unknown_name_line(const std::string& why) {
  return why + ". The dance in this house goes on; the name is looked up again every 5 s";
}

}  // namespace dance
