// Files of avatars in the server's memory: which are kept, and which leave for others.
#include <algorithm>

#include "tunnel/server/signals/server_files.h"
#include "tunnel/wire/state_bytes.h"

namespace dance {
namespace {

constexpr std::ptrdiff_t kMostFilesOfGuest = 2;  // the chosen one, and the one before
// A file in use is not evicted for another.
constexpr Duration kInUse = Duration::s(10);

}  // namespace

std::optional<AvatarFile> ServerFiles::chosen_by(const ServerGuest& guest) {
  const RetainedState& state = guest.states[wire::place_of({wire::StateKind::kAvatarFile, 0})];
  AvatarFile file;
  if (state.version == 0 || !decode_from_tunnel(state.bytes(), file) || !file.hash.is_set())
    return std::nullopt;
  return file;
}

// Chunks of it are sent or received now, and the guest still has it chosen.
bool ServerFiles::is_in_use(const File& file, MonoTime now) {
  const ServerGuest* guest = guest_in(file.room, file.name.slot);
  if (guest == nullptr || now - file.used > kInUse) return false;
  const auto chosen = chosen_by(*guest);
  return chosen && chosen->hash == file.name.hash;
}

// Removes the longest unused of those that match; false where all of them are in use.
template <class Matches>
bool ServerFiles::evict(const Matches& matches, MonoTime now) {
  auto oldest = files_.end();
  for (auto it = files_.begin(); it != files_.end(); ++it)
    if (matches(*it) && (oldest == files_.end() || it->used < oldest->used) && !is_in_use(*it, now))
      oldest = it;
  if (oldest == files_.end()) return false;
  forget(oldest);
  return true;
}

// `name` is what the guest has chosen, so its other files are not in use.
ServerFiles::File* ServerFiles::find_or_add(std::size_t room, const wire::FileName& name,
                                            std::uint32_t size_bytes, MonoTime now) {
  for (auto it = files_.begin(); it != files_.end(); ++it) {
    if (it->room != room || it->name != name) continue;
    if (it->chunks.size_bytes() == size_bytes) return &*it;
    forget(it);  // chosen again, with another size
    break;
  }
  const auto of_guest = [&](const File& it) {
    return it.room == room && it.name.slot == name.slot;
  };
  while (std::ranges::count_if(files_, of_guest) >= kMostFilesOfGuest)
    if (!evict(of_guest, now)) return nullptr;
  if (files_.size() >= server_.limits.files && !evict([](const File&) { return true; }, now))
    return nullptr;
  if (!make_room(guest_in(room, name.slot)->owner, size_bytes, now)) return nullptr;
  files_.push_back({room, name, ChunkedFile(size_bytes), {}, now});
  size_bytes_ += size_bytes;
  return &files_.back();
}

void ServerFiles::forget(std::list<File>::iterator file) {
  size_bytes_ -= file->chunks.size_bytes();
  files_.erase(file);
}

const ServerSession* ServerFiles::owner_of(const File& file) const {
  const ServerRoom& room = server_.rooms[file.room];
  const ServerGuest& guest = room.guests[file.name.slot.slot];
  return room.in_use && guest.in_use && guest.generation == file.name.slot.generation
             ? &server_.sessions[guest.owner]
             : nullptr;
}

template <class Matches>
ServerFiles::Held ServerFiles::held_by(const Matches& matches) const {
  Held held;
  for (const File& file : files_) {
    const ServerSession* owner = owner_of(file);
    if (owner == nullptr || !matches(*owner)) continue;
    ++held.files;
    held.bytes += file.chunks.size_bytes();
  }
  return held;
}

std::size_t ServerFiles::bytes_of_key(const GuestId& key) const {
  const auto has_key = [&](const ServerSession& owner) {
    return !owner.is_remote() && owner.access.name == key;
  };
  return held_by(has_key).bytes;
}

// The files of a session have a limit, and so have those of all sessions with one key. Another
// server of the cluster limits its own links.
bool ServerFiles::make_room(std::size_t index, std::uint32_t size_bytes, MonoTime now) {
  const auto& limits = server_.limits;
  const ServerSession& session = server_.sessions[index];
  if (size_bytes > limits.file_bytes_per_session || size_bytes > limits.file_bytes) return false;
  const auto make_room_of = [&](const auto& is_owner, std::size_t files, std::size_t bytes) {
    const auto matches = [&](const File& it) {
      const ServerSession* owner = owner_of(it);
      return owner != nullptr && is_owner(*owner);
    };
    for (;;) {
      const Held held = held_by(is_owner);
      if (held.files < files && held.bytes + size_bytes <= bytes) return true;
      if (!evict(matches, now)) return false;
    }
  };
  const auto is_session = [&](const ServerSession& owner) { return &owner == &session; };
  const auto has_key = [&](const ServerSession& owner) {
    return !owner.is_remote() && owner.access.name == session.access.name;
  };
  const KeyQuota quota = quota_of(session.access, limits);
  if (!session.is_remote() &&
      (!make_room_of(is_session, quota.files, limits.file_bytes_per_session) ||
       !make_room_of(has_key, quota.files, quota.file_bytes)))
    return false;
  while (size_bytes_ + size_bytes > limits.file_bytes)
    if (!evict([](const File&) { return true; }, now)) return false;
  return true;
}

}  // namespace dance
