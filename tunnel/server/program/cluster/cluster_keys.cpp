#include "tunnel/server/program/cluster/cluster_keys.h"

#include <utility>

#include "core/base/printable.h"
#include "tunnel/seal/keys/key_files.h"

namespace dance {
namespace {

constexpr std::size_t kMostNamed = 20;
constexpr const char* kWrongCure = "; --remove-key takes it away";

Result<KeyEntry> entry_in(const GuestId& name, std::string_view line) {
  const std::string where = "the cluster's key of '" + std::string(name.view()) + "'";
  DANCE_TRY(const KeyRing ring, KeyRing::parse(line, where));
  if (ring.entries().size() != 1 || ring.entries()[0].name != name)
    return fail(where + " is another's, or none");
  if (ring.entries()[0].invitation)
    return fail(where + " is an invitation, which a cluster does not take");
  return ring.entries()[0];
}

}  // namespace

std::string other_cluster_identity_line(const std::string& cluster) {
  return cluster +
         " has another identity than this server, so its guests would not trust this server: copy "
         "server-identity.key, which is beside the file of keys, from a server of the cluster to "
         "this one";
}

std::optional<std::string> ClusterKeys::other_identity(const PublicKey& own) const {
  if (!server_key_.is_set() || server_key_ == own) return std::nullopt;
  return other_cluster_identity_line("the cluster");
}

void ClusterKeys::take(std::string_view name, std::optional<std::string_view> line) {
  if (name == kClusterIdentity) {
    const auto key = line ? PublicKey::parse(*line) : std::nullopt;
    if (line && !key) note_wrong("the cluster's identity is no key");
    if (server_key_ == key.value_or(PublicKey())) return;
    server_key_ = key.value_or(PublicKey());
    has_changed_ = true;
    return;
  }
  const auto id = GuestId::parse(name);
  if (!id || name == kLocalKeyName)
    return line ? note_wrong("a key of the cluster has a name that none can have: '" +
                             printable(name.substr(0, kMaxGuestIdLength)) + "'")
                : void();
  const auto known = entries_.find(*id);
  expected_.erase(*id);
  std::optional<KeyEntry> entry;
  if (line && line->size() > kLongest) {
    note_wrong("the cluster's key of '" + std::string(name) + "' is longer than any");
  } else if (line) {
    auto parsed = entry_in(*id, *line);
    if (!parsed)
      note_wrong(printable(parsed.error().what));
    else if (known == entries_.end() && entries_.size() >= KeyRing::kMost)
      note_wrong("the cluster has more keys than a server takes: '" + std::string(name) + "'");
    else
      entry = *parsed;
  }
  if (!entry) {
    if (known == entries_.end()) return;
    entries_.erase(known);
  } else {
    if (known != entries_.end() && known->second == *entry) return;
    entries_.insert_or_assign(*id, *entry);
  }
  has_changed_ = true;
}

void ClusterKeys::expect_again() {
  for (const auto& [name, entry] : entries_) expected_.insert(name);
}

std::optional<std::string> ClusterKeys::take_lost() {
  const std::set<GuestId> lost = std::exchange(expected_, {});
  if (lost.empty()) return std::nullopt;
  std::string names;
  std::size_t named = 0;
  for (const GuestId& name : lost) {
    if (named == kMostNamed) break;
    names += (named++ == 0 ? "" : ", ") + std::string(name.view());
  }
  if (lost.size() > named) names += " and " + std::to_string(lost.size() - named) + " more";
  return "the cluster has lost the keys of " + names +
         ": they open this server until it ends, and no server that starts; make them again with "
         "dance server --cluster … --new-guest";
}

bool ClusterKeys::take_changed() { return std::exchange(has_changed_, false); }

void ClusterKeys::note_wrong(std::string what) {
  ++wrong_count_;
  wrong_ = std::move(what);
}

std::optional<std::string> ClusterKeys::take_wrong() {
  const std::size_t count = std::exchange(wrong_count_, 0);
  if (count == 0) return std::nullopt;
  return std::move(wrong_) + (count > 1 ? " (and " + std::to_string(count - 1) + " more)" : "") +
         "; it opens nothing" + kWrongCure;
}

}  // namespace dance
