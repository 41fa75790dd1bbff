#include "tunnel/server/program/server_keys.h"

#include <algorithm>

#include "tunnel/seal/keys/key_files.h"

namespace dance {

Result<ServerKeys> ServerKeys::open(const std::string& path) {
  ServerKeys keys;
  keys.path_ = path;
  if (path.empty()) {
    DANCE_TRY(const std::string folder, key_folder());
    keys.path_ = folder + "/server-keys";
  }
  DANCE_TRY(keys.identity_, server_identity(keys.path_));
  if (auto done = keys.read(); !done) return tl::make_unexpected(done.error());
  return keys;
}

Result<void> ServerKeys::read() {
  DANCE_TRY(const auto text, read_secret(path_));
  const std::string now = text.value_or("");
  DANCE_TRY(KeyRing ring, KeyRing::parse(now, path_));
  DANCE_TRY(of_file_, with_local_key(std::move(ring)));
  read_text_ = now;
  unite();
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

std::size_t ServerKeys::guest_count() const {
  return static_cast<std::size_t>(std::ranges::count_if(ring_->entries(), [](const KeyEntry& it) {
    return !it.is_local() && (it.has_key || it.is_invited());
  }));
}

void ServerKeys::set_cluster(std::map<GuestId, KeyEntry> keys) {
  of_cluster_ = std::move(keys);
  unite();
}

// In the order of names, so that each goes to the end of the ring.
void ServerKeys::unite() {
  std::map<GuestId, KeyEntry> all = of_cluster_;
  in_both_ = 0;
  for (const KeyEntry& entry : of_file_.entries())
    if (!all.emplace(entry.name, entry).second) ++in_both_;
  KeyRing ring;
  if (const KeyEntry* local = of_file_.find(kLocalKeyName)) ring.add(*local);
  left_out_ = 0;
  for (const auto& [name, entry] : all)
    if (!entry.is_local() && !ring.add(entry)) ++left_out_;
  ring_ = std::make_shared<const KeyRing>(std::move(ring));
}

}  // namespace dance
