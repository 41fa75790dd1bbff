#include "tunnel/server/program/server_keys.h"

#include <cstdio>

#include "core/program/talk.h"
#include "tunnel/seal/house_keys.h"
#include "tunnel/seal/key_files.h"

namespace dance {
namespace {

Result<KeyEntry> entry_of(const KeyCommand& command) {
  KeyEntry entry;
  const bool is_room = !command.new_room_key.empty();
  const std::string& name = is_room ? command.new_room_key : command.new_guest;
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
  entry.key = PresharedKey::make();
  return entry;
}

void print_list(const KeyRing& ring) {
  std::printf("%-24s  %-8s  %s\n", "name", "kind", "room");
  for (const KeyEntry& entry : ring.entries())
    std::printf("%-24s  %-8s  %s\n", entry.name.c_str(),
                std::string(key_kind_name(entry.kind)).c_str(),
                entry.room.is_set() ? entry.room.c_str() : "every room");
}

}  // namespace

Result<ServerKeys> ServerKeys::open(const std::string& path) {
  ServerKeys keys;
  keys.path_ = path;
  if (path.empty()) {
    DANCE_TRY(const std::string folder, key_folder());
    keys.path_ = folder + "/server-keys";
  }
  if (auto done = keys.read(); !done) return tl::make_unexpected(done.error());
  return keys;
}

Result<void> ServerKeys::read() {
  DANCE_TRY(const auto text, read_secret(path_));
  const std::string now = text.value_or("");
  DANCE_TRY(KeyRing ring, KeyRing::parse(now, path_));
  DANCE_TRY(ring, with_local_key(std::move(ring)));
  ring_ = std::make_shared<const KeyRing>(std::move(ring));
  read_text_ = now;
  return {};
}

Result<bool> ServerKeys::read_again() {
  const auto text = read_secret(path_);
  const bool is_same = text && text->value_or("") == read_text_;
  if (is_same) {
    was_bad_ = false;
    return false;
  }
  if (auto done = read(); !done) {
    if (was_bad_) return false;
    was_bad_ = true;
    return tl::make_unexpected(done.error());
  }
  was_bad_ = false;
  return true;
}

Result<void> ServerKeys::run(const KeyCommand& command) {
  DANCE_TRY(KeyRing ring, load_server_keys(path_));
  if (command.list) {
    print_list(ring);
    return {};
  }
  if (!command.remove.empty()) {
    if (!ring.remove(command.remove))
      return fail("there is no key of '" + command.remove + "' in " + path_ +
                  "; --list-keys says whose there are");
    if (auto written = write_secret(path_, ring.text()); !written) return written;
    talk::info("{}'s key is gone; a server that runs lets nobody in with it from now on",
               command.remove);
    return {};
  }
  DANCE_TRY(const KeyEntry entry, entry_of(command));
  HouseKey line;
  line.name = entry.name;
  line.room = entry.room;
  line.key = entry.key;
  if (!command.address.empty()) line.server = server_name_of(command.address, 0);
  // The line must be one that the other side can read.
  if (const auto back = HouseKey::parse(line.line()); !back || back->title() != line.title())
    return fail("--address '" + command.address + "' is no HOST or HOST:PORT");
  if (!ring.add(entry))
    return fail("'" + std::string(entry.name.view()) + "' has a key already in " + path_ +
                "; --remove-key takes it away");
  if (auto written = write_secret(path_, ring.text()); !written) return written;
  std::printf("%s\n", line.line().c_str());
  return {};
}

}  // namespace dance
