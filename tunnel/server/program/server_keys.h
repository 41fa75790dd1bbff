// The keys of `dance server`: the file that it reads and reads again when it changes, and the
// commands that change it.
//
// Units/frames: none.
// Ownership:    plain values; rings are shared and never changed.
// Threads:      none inside.
// Failure:      each says which file or name, and the cure; a file that has become bad leaves the
//               keys as they were.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "tunnel/seal/key_ring.h"

namespace dance {

// Changes to the file that end at once, without a server.
struct KeyCommand {
  std::string new_guest;
  std::string new_room_key;
  std::string remove;
  bool list = false;
  KeyKind kind = KeyKind::kGuest;
  std::string room;     // the only one that the key opens; "" = every room
  std::string address;  // HOST[:PORT] as guests reach this server, for the line that they paste
  bool is_given() const {
    return !new_guest.empty() || !new_room_key.empty() || !remove.empty() || list;
  }
};

class ServerKeys {
 public:
  // `path` "" = server-keys in the folder of keys.
  static Result<ServerKeys> open(const std::string& path);

  // What it has to say goes to stdout: the line to paste, the list.
  Result<void> run(const KeyCommand& command);
  // With the key of this machine.
  std::shared_ptr<const KeyRing> ring() const { return ring_; }
  const std::string& path() const { return path_; }
  std::size_t guest_count() const { return ring_->entries().size() - 1; }
  // True where the file had changed and was read again; its error, once, where it is bad.
  Result<bool> read_again();

 private:
  Result<void> read();

  std::string path_;
  std::string read_text_;
  bool was_bad_ = false;
  std::shared_ptr<const KeyRing> ring_;
};

}  // namespace dance
