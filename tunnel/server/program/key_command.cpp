#include "tunnel/server/program/key_command.h"

#include <cstdio>

#include "core/program/standard_output.h"
#include "core/program/talk.h"
#include "tunnel/seal/keys/house_keys.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/seal/keys/utc_text.h"
#include "tunnel/server/program/secret_delivery.h"

namespace dance {
namespace {

constexpr std::int64_t kMostDaysOfKey = 3650;

// The entry of a new key or invitation, before its key is set.
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
  if (!command.key_for.empty()) {
    DANCE_TRY(const std::int64_t valid_s,
              parse_validity_s("--key-for", command.key_for, kMostDaysOfKey));
    entry.until_s = (utc_now_s() + valid_s) / 60 * 60;
  }
  return entry;
}

std::string state_of(const KeyEntry& entry, std::int64_t now_s) {
  if (!entry.is_invited() && !entry.until_s) return "";
  if (!entry.is_invited())
    return (entry.has_expired(now_s) ? "key expired " : "key until ") + utc_shown(*entry.until_s);
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

void add_key_options(CommandLine& line, KeyCommand& keys) {
  line.add("--invite", keys.invite,
           "makes an invitation for NAME, prints the link that NAME opens, and ends")
      .guest_name();
  line.add("--for", keys.invitation.valid_for, "how long --invite is good: 90m, 24h, 7d; up to 90d")
      .shows_default();
  line.add(
      "--key-for", keys.key_for,
      "how long the key of --new-guest, --new-room-key or --invite opens rooms: 24h, 90d; up to "
      "3650d (else until it is removed)");
  line.add_flag("--qr", keys.invitation.has_qr, "shows --invite as a QR code too");
  line.add("--qr-file", keys.invitation.qr_file,
           "writes the QR code of --invite into an .svg file that you alone may read");
  line.add("--new-guest", keys.new_guest,
           "makes a key for NAME, prints the line that NAME pastes, and ends")
      .guest_name();
  line.add(
      "--public-key", keys.public_key,
      "with --new-guest: the key that the guest's dance key --public prints, so that no secret "
      "has to be sent");
  line.add_choice<KeyKind>(
      "--role", keys.kind,
      {{"guest", KeyKind::kGuest}, {"host", KeyKind::kHost}, {"listener", KeyKind::kListener}},
      "what --invite or --new-guest may do: dance; set music and scene too; only hear");
  line.add("--room", keys.room, "the only room that --invite or --new-guest may enter");
  line.add("--new-room-key", keys.new_room_key,
           "makes a key for all who come to ROOM, prints its line, and ends")
      .guest_name();
  line.add("--address", keys.address,
           "HOST[:PORT] as guests reach this server, for the line that they get");
  line.add("--remove-key", keys.remove,
           "takes NAME's key or invitation away: NAME is out at once; and ends")
      .check(
          [](const std::string& name) { return std::string(name.empty() ? "names no key" : ""); });
  line.add_flag("--list-keys", keys.list,
                "the server's public key, and whose keys and open invitations there are; and ends");
}

Result<void> run_key_command(const KeyCommand& command, KeyStore& store) {
  if (command.list) {
    DANCE_TRY(const KeyRing ring, store.read());
    DANCE_TRY(const auto server_key, store.read_server_key());
    print_list(ring);
    if (server_key) talk::info("the server's public key is {}", server_key->text());
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
  if (!command.public_key.empty() && command.new_guest.empty())
    return fail("--public-key belongs to --new-guest: it is the key of one guest's house");
  DANCE_TRY(KeyEntry entry, entry_of(command));
  if (!command.invite.empty())
    return run_invite_command(entry, command.address, command.port, command.invitation, store);
  HouseKey line;
  line.name = entry.name;
  line.room = entry.room;
  if (command.public_key.empty()) {
    line.grant = PrivateKey::make();
    entry.key = line.grant->public_key();
  } else {
    const auto house = PublicKey::parse(command.public_key);
    if (!house || !house->is_on_curve())
      return fail(
          "--public-key is no key of a house: it has 44 characters, and the guest's dance "
          "key --public prints it");
    entry.key = *house;
  }
  if (!command.address.empty()) line.server = server_name_of(command.address, 0);
  DANCE_TRY(line.server_key, store.claim_server_key());
  // The line must be one that the other side can read.
  if (const auto back = HouseKey::parse(line.line()); !back || back->title() != line.title())
    return fail("--address '" + command.address + "' is no HOST or HOST:PORT");
  DANCE_TRY(const bool is_new, store.add(entry));
  if (!is_new)
    return fail("'" + std::string(entry.name.view()) + "' has a key or an invitation already in " +
                store.name() + "; --remove-key takes it away");
  if (auto kept = keep_or_revoke(write_to_stdout(line.line() + "\n"), entry.name.c_str(), store);
      !kept)
    return kept;
  if (entry.until_s) talk::info("opens rooms until {}", utc_shown(*entry.until_s));
  return {};
}

}  // namespace dance
