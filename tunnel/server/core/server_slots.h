// The slots of a room: which guest is in which, through which session.
//
// Units/frames: sessions and rooms by index.
// Ownership:    refers to the server's context.
// Threads:      none inside; one owner.
// Failure:      a room without a free slot takes nobody.
#pragma once

#include "tunnel/server/core/server_context.h"

namespace dance {

class ServerSlots {
 public:
  explicit ServerSlots(ServerContext& server) : server_(server) {}

  // Where the guest is; nothing where it is not in the room.
  static std::optional<std::uint8_t> find(const ServerRoom& room, const GuestId& guest);
  // Nothing where the room is full.
  std::optional<std::uint8_t> add_guest(std::size_t session, const GuestId& id,
                                        std::uint64_t link_token, const OwnerKey& key);
  void remove_guest(std::size_t room, std::uint8_t slot);
  // The guest comes through another session now, and keeps its states; also its slot and
  // generation, where a link that comes to have it may have that slot.
  void move_guest(ServerRoom& room, std::uint8_t slot, std::size_t to);

 private:
  std::uint8_t relocate(ServerRoom& room, std::uint8_t slot);
  static std::optional<std::uint8_t> free_slot(const ServerRoom& room, bool is_remote);
  void want_no_more(const ServerRoom& room, ServerGuest& guest);
  void begin_slot(ServerRoom& room, std::uint8_t slot);

  ServerContext& server_;
};

}  // namespace dance
