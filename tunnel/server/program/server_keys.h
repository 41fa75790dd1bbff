// The identity of `dance server`, and the keys that it lets in: those of its file, which it reads
// again when it changes, and those of its cluster.
//
// Units/frames: none.
// Ownership:    plain values; rings are shared and never changed.
// Threads:      none inside.
// Failure:      each says which file or name, and the cure; a file that has become bad leaves the
//               keys as they were.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "tunnel/seal/keys/key_ring.h"

namespace dance {

class ServerKeys {
 public:
  // `path` "" = server-keys in the folder of keys.
  static Result<ServerKeys> open(const std::string& path);

  // With the key of this machine.
  std::shared_ptr<const KeyRing> ring() const { return ring_; }
  const std::string& path() const { return path_; }
  const PrivateKey& identity() const { return identity_; }
  // Guests and rooms that have a key, or an invitation that is open.
  std::size_t guest_count() const;
  // True where the file had changed and was read again; its error, once, where it is bad.
  Result<bool> read_again();
  // From now on those of the cluster are these.
  void set_cluster(std::map<GuestId, KeyEntry> keys);
  // Names that have a key in both: the cluster's counts.
  std::size_t in_both() const { return in_both_; }
  // Keys beyond what a ring takes.
  std::size_t left_out() const { return left_out_; }

 private:
  Result<void> read();
  void unite();

  std::string path_;
  PrivateKey identity_;
  std::string read_text_;
  bool was_bad_ = false;
  KeyRing of_file_;  // and the key of this machine
  std::map<GuestId, KeyEntry> of_cluster_;
  std::size_t in_both_ = 0;
  std::size_t left_out_ = 0;
  std::shared_ptr<const KeyRing> ring_;
};

}  // namespace dance
