#include "tunnel/server/program/key_command.h"

#include <cstdio>

#include "core/program/talk.h"
#include "tunnel/seal/house_keys.h"
#include "tunnel/seal/key_files.h"
#include "tunnel/seal/utc_text.h"

namespace dance {
namespace {

// Of a new key or of an invitation, without either.
Result<KeyEntry> entry_of(const KeyCommand& command) {
  KeyEntry entry;
  const bool is_room = !command.new_room_key.empty();
  const std::string& name = is_room                   ? command.new_room_key
                            : !command.invite.empty() ? command.invite
                                                      : command.new_guest;
  const auto id = GuestId::parse(name);
  if (!id) return fail("'" + name + "': " + kGuestIdRule);
  if (name == kLocalKeyName)
    return fail(std::string("'") + kLocalKeyName + "' is the name of this machine; choose another");
  entry.name = *id;
  entry.kind = is_room ? KeyKind::kRoom : command.kind;
  if (is_room) entry.room = *id;
  if (!is_room && !command.room.empty()) {
    const auto room = GuestId::parse(command.room);
    if (!room)
      return fail("--room '" + command.room +
                  "': a room's name is 1 to 24 characters of a-z, 0-9 and '-'");
    entry.room = *room;
  }
  return entry;
}

std::string state_of(const KeyEntry& entry, std::int64_t now_s) {
  if (!entry.is_invited()) return "";
  return (now_s < entry.invitation->until_s ? "invited, until " : "invitation expired ") +
         utc_shown(entry.invitation->until_s);
}

void print_list(const KeyRing& ring) {
  std::printf("%-24s  %-8s  %s\n", "name", "kind", "room");
  const std::int64_t now_s = utc_now_s();
  for (const KeyEntry& entry : ring.entries()) {
    if (!entry.has_key && !entry.is_invited()) continue;
    const std::string state = state_of(entry, now_s);
    std::printf(state.empty() ? "%-24s  %-8s  %s%s\n" : "%-24s  %-8s  %-24s  %s\n",
                entry.name.c_str(), std::string(key_kind_name(entry.kind)).c_str(),
                entry.room.is_set() ? entry.room.c_str() : "every room", state.c_str());
  }
}

}  // namespace

Result<void> run_key_command(const KeyCommand& command, KeyStore& store) {
  if (command.list) {
    DANCE_TRY(const KeyRing ring, store.read());
    print_list(ring);
    return {};
  }
  if (!command.remove.empty()) {
    DANCE_TRY(const bool was_there, store.remove(command.remove));
    if (!was_there)
      return fail("there is no key of '" + command.remove + "' in " + store.name() +
                  "; --list-keys says whose there are");
    talk::info(
        "{}'s key or invitation is gone; a server that runs lets nobody in with it from now on",
        command.remove);
    return {};
  }
  DANCE_TRY(KeyEntry entry, entry_of(command));
  if (!command.invite.empty())
    return run_invite_command(entry, command.address, command.port, command.invitation, store);
  entry.key = PresharedKey::make();
  HouseKey line;
  line.name = entry.name;
  line.room = entry.room;
  line.key = entry.key;
  if (!command.address.empty()) line.server = server_name_of(command.address, 0);
  // The line must be one that the other side can read.
  if (const auto back = HouseKey::parse(line.line()); !back || back->title() != line.title())
    return fail("--address '" + command.address + "' is no HOST or HOST:PORT");
  DANCE_TRY(const bool is_new, store.add(entry));
  if (!is_new)
    return fail("'" + std::string(entry.name.view()) + "' has a key or an invitation already in " +
                store.name() + "; --remove-key takes it away");
  std::printf("%s\n", line.line().c_str());
  return {};
}

}  // namespace dance
