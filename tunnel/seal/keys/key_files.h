// Where keys lie on a machine, and how they get there: files that only their owner may read,
// replaced whole, so that nobody ever finds half of one.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      any. Who reads, changes and writes a file holds its lock meanwhile.
// Failure:      each says which file, why, and the cure.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "core/base/result.h"
#include "tunnel/seal/keys/house_keys.h"
#include "tunnel/seal/keys/key_ring.h"

namespace dance {

// $XDG_CONFIG_HOME/dance, or ~/.config/dance.
Result<std::string> key_folder();

// Refuses what others may read. nullopt: there is no such file.
Result<std::optional<std::string>> read_secret(const std::string& path);
Result<void> write_secret(const std::string& path, const std::string& text);

// Held by one program at a time, until it ends or the object goes. Taking it waits for as long as
// another holds it.
class FileLock {
 public:
  // Of all files in the folder of `path`, which is made where there is none.
  static Result<FileLock> of_folder(const std::string& path);
  // Of something else: an empty file of that name, which stays.
  static Result<FileLock> of_file(const std::string& path);
  ~FileLock();
  FileLock(FileLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileLock& operator=(FileLock&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }

 private:
  explicit FileLock(int fd) : fd_(fd) {}
  static Result<FileLock> take(int fd, const std::string& name);

  int fd_;
};

// The key between programs of this user on this machine, made by the first that needs it.
constexpr const char* kLocalKeyName = "local";
Result<PresharedKey> local_key();
// The identity of this user's houses, made by the first program that needs it: identity.key in
// `folder` ("" = key_folder()).
Result<PrivateKey> house_identity(std::string folder = "");
// The identity of a server, made likewise: server-identity.key beside its file of keys. Servers of
// a cluster have copies of one file.
Result<PrivateKey> server_identity(const std::string& keys_path);
std::string server_identity_path(const std::string& keys_path);

// A server's keys, without those of this machine; an empty ring where there is no file.
Result<KeyRing> load_server_keys(const std::string& path);
// The same, with the local key.
Result<KeyRing> with_local_key(KeyRing ring);

}  // namespace dance
