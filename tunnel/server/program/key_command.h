// The commands of `dance server` that make, list and take away keys, and end: in its file, or in a
// cluster's bucket.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      one.
// Failure:      each says which name or store, and the cure. Nothing shows a key but the line of a
//               new one, once, on stdout.
#pragma once

#include <string>

#include "core/program/command_line.h"
#include "tunnel/server/program/invite_command.h"
#include "tunnel/server/program/key_store.h"

namespace dance {

struct KeyCommand {
  std::string new_guest;
  std::string invite;
  InviteOptions invitation;
  std::string new_room_key;
  std::string remove;
  bool list = false;
  KeyKind kind = KeyKind::kGuest;
  std::string public_key;  // of the new guest's house; "" = a grant is made
  std::string key_for;     // as 90d: how long the key opens rooms; "" = until it is removed
  std::string room;        // the only one that the key opens; "" = every room
  std::string address;     // HOST[:PORT] as guests reach this server, for the line that they get
  std::uint16_t port = kInvitationPort;  // where `address` names none
  bool is_given() const {
    return !new_guest.empty() || !invite.empty() || !new_room_key.empty() || !remove.empty() ||
           list;
  }
};

void add_key_options(CommandLine& line, KeyCommand& keys);

// Writes its result to stdout: the line to paste, or the list.
Result<void> run_key_command(const KeyCommand& command, KeyStore& store);

}  // namespace dance
