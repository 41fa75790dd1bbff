// AvatarStore: avatars' files on this machine, each named by the SHA-256 of its bytes: this user's
// own, which stay, and those that came from other houses, of which the longest unused make room for
// new ones. Nothing in here looks into a file.
//
//   $XDG_DATA_HOME/dancegraph/avatars/<sha256>.vrm    own; ~/.local/share without the variable
//   $XDG_CACHE_HOME/dancegraph/avatars/<sha256>.vrm   of others; ~/.cache
//   …                                 /<sha256>.<guest>.part  of others, what has come so far
//
// Units/frames: bytes.
// Ownership:    folders of mode 0700, files of mode 0600, written beside, checked and then renamed.
// Threads:      any; of two processes that write one file, one wins, with the same bytes.
// Failure:      names the file and the reason. Damaged files count as absent; those of others are
//               removed, those of this user stay where they are.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/file_hash.h"
#include "core/base/guest_id.h"
#include "core/base/result.h"

namespace dance {

struct StoredAvatar {
  FileHash hash;
  std::string path;
  std::size_t size_bytes = 0;
  bool is_own = false;
};

class AvatarStore {
 public:
  static constexpr std::size_t kMostFileBytes = std::size_t{16} << 20;
  static constexpr std::size_t kMostForeignBytes = std::size_t{256} << 20;

  // Where this user's environment says.
  static AvatarStore of_user();
  AvatarStore(std::string own_folder, std::string foreign_folder,
              std::size_t most_foreign_bytes = kMostForeignBytes);

  // "" = not here. One of another house counts as used now.
  std::string find(const FileHash& hash) const;
  // Its bytes, if it is here and they have that hash.
  std::optional<std::vector<std::uint8_t>> read(const FileHash& hash) const;

  // One of this user's own: reads it, and keeps a copy. `path` may be any file.
  struct Kept {
    FileHash hash;
    std::vector<std::uint8_t> bytes;
  };
  static Result<Kept> read_file(const std::string& path);
  Result<void> keep_own(const Kept& kept, bool is_vrm) const;

  // One of another house, in pieces. False where the hash is another: nothing is kept then.
  using Pieces = std::vector<std::span<const std::uint8_t>>;
  Result<bool> keep_foreign(const FileHash& hash, const Pieces& pieces, bool is_vrm) const;

  // What has come of one so far, from its begin: for after a restart. By guest too: what one has
  // sent under that hash, with whatever bytes, is no part of another's.
  Result<void> add_part(const GuestId& guest, const FileHash& hash, std::size_t offset,
                        std::span<const std::uint8_t> bytes) const;
  std::vector<std::uint8_t> part(const GuestId& guest, const FileHash& hash) const;
  void forget_part(const GuestId& guest, const FileHash& hash) const;

  std::vector<StoredAvatar> list() const;
  const std::string& own_folder() const { return own_; }
  const std::string& foreign_folder() const { return foreign_; }

 private:
  Result<void> make_room(std::size_t bytes) const;

  std::string own_;
  std::string foreign_;
  std::size_t most_foreign_bytes_;
};

// Names of the avatars that are installed with the programs, in their order.
std::vector<std::string> shipped_avatars(const std::string& shipped_folder);

}  // namespace dance
