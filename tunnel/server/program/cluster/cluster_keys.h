// The keys of a cluster as a server knows them: one value of the bucket for each, whose key is the
// name and whose bytes are the line that would stand in the file; and one value with the public key
// that all servers of the cluster have, so that guests can go from one to another.
//
// Units/frames: none.
// Ownership:    copies what it takes.
// Threads:      none inside.
// Failure:      what is no key of that name opens nothing; take_wrong() says which it is. At most
//               KeyRing::kMost keys; further ones are wrong.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "tunnel/seal/keys/key_ring.h"

namespace dance {

// No guest can have this name.
constexpr std::string_view kClusterIdentity = "_identity";
std::string other_cluster_identity_line(const std::string& cluster);

class ClusterKeys {
 public:
  // No line: the key was taken away.
  void take(std::string_view name, std::optional<std::string_view> line);

  const std::map<GuestId, KeyEntry>& entries() const { return entries_; }
  // The error for a server with this key if the cluster's servers have another; nullopt if they
  // have this one, or if no guest of the cluster has a key yet.
  std::optional<std::string> other_identity(const PublicKey& own) const;
  // Whether they are others than at the last call.
  bool take_changed();
  // The newest wrong entry since the last call, printable and without a key.
  std::optional<std::string> take_wrong();
  // The bucket has lost its keys. They stay, and those that take() does not get again are lost.
  void expect_again();
  // One line that names the lost keys; nullopt if none was lost since expect_again().
  std::optional<std::string> take_lost();

 private:
  // A line is not longer: two names, a kind and a key.
  static constexpr std::size_t kLongest = 160;

  void note_wrong(std::string what);

  std::map<GuestId, KeyEntry> entries_;
  PublicKey server_key_;
  bool has_changed_ = false;
  std::size_t wrong_count_ = 0;  // since the last report
  std::string wrong_;
  std::set<GuestId> expected_;
};

}  // namespace dance
