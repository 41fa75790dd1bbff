// Where the keys of `dance server` lie: its own file, or the bucket that all servers of a cluster
// share.
//
// Units/frames: none.
// Ownership:    a store owns its connection.
// Threads:      one; a bucket's calls wait for NATS, a file's for another program that changes it.
// Failure:      each says which file or bucket, and the cure.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "tunnel/nats/nats_options.h"
#include "tunnel/seal/keys/key_ring.h"

namespace dance {

class KeyStore {
 public:
  virtual ~KeyStore() = default;
  // Its name in error messages.
  virtual std::string name() const = 0;
  // Reports wrong entries on stderr, one line each, and leaves them out.
  virtual Result<KeyRing> read() = 0;
  // The public key of the server, or of all servers of the cluster; nothing: the cluster has none
  // yet. Writes nothing.
  virtual Result<std::optional<PublicKey>> read_server_key() = 0;
  // The same, for a line that a guest gets. The first such line makes the key of this machine that
  // of the whole cluster; a machine with another key then fails.
  virtual Result<PublicKey> claim_server_key() = 0;
  // False where the name has a key or an open invitation already.
  virtual Result<bool> add(const KeyEntry& entry) = 0;
  // Takes the place of an open invitation; false where the name has a key.
  virtual Result<bool> invite(const KeyEntry& entry) = 0;
  // Like KeyRing::bind(), and stores the result.
  virtual Result<Binding> bind(const std::string& name, const PublicKey& house) = 0;
  // False where there is none of that name.
  virtual Result<bool> remove(const std::string& name) = 0;
};

// What a cluster's store says to invite().
std::string no_invitations_line(std::string_view guest);

std::unique_ptr<KeyStore> file_key_store(const std::string& path);
// The options' bucket does not count.
// `own`: the identity of this server. A cluster takes it as its own with the first key, and refuses
// another one from then on.
Result<std::unique_ptr<KeyStore>> cluster_key_store(const NatsOptions& options,
                                                    const PublicKey& own);

}  // namespace dance
