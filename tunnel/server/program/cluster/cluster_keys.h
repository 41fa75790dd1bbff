// The keys of a cluster as a server knows them: one value of the bucket for each, whose key is the
// name and whose bytes are the line that would stand in the file.
//
// Units/frames: none.
// Ownership:    copies what it takes.
// Threads:      none inside.
// Failure:      what is no key of that name opens nothing; take_wrong() says which it is. At most
//               KeyRing::kMost keys; further ones are wrong.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "tunnel/seal/key_ring.h"

namespace dance {

class ClusterKeys {
 public:
  // No line: the key was taken away.
  void take(std::string_view name, std::optional<std::string_view> line);

  const std::map<GuestId, KeyEntry>& entries() const { return entries_; }
  // Whether they are others than at the last call.
  bool take_changed();
  // The newest wrong entry since the last call, printable and without a key.
  std::optional<std::string> take_wrong();

 private:
  // A line is not longer: two names, a kind and a key.
  static constexpr std::size_t kLongest = 160;

  void note_wrong(std::string what);

  std::map<GuestId, KeyEntry> entries_;
  bool has_changed_ = false;
  std::size_t wrong_count_ = 0;  // since it was said last
  std::string wrong_;
};

}  // namespace dance
