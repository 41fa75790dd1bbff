#include "core/store/avatar_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/store/folder_entries.h"
#include "core/store/sha256.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 2> kEndings{".vrm", ".glb"};
constexpr std::string_view kPartEnding = ".part";
constexpr std::string_view kNewEnding = ".new";

std::string reason() { return std::strerror(errno); }

class File {
 public:
  File(const std::string& path, int flags, mode_t mode = 0)
      : fd_(::open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, mode)) {}
  ~File() {
    if (fd_ >= 0) ::close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  bool is_open() const { return fd_ >= 0; }
  int fd() const { return fd_; }
  bool write(std::span<const std::uint8_t> bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
  }
  // A regular file's, if there are at most so many.
  std::optional<std::vector<std::uint8_t>> read(std::size_t most) const {
    struct stat status {};
    if (fstat(fd_, &status) != 0 || !S_ISREG(status.st_mode) ||
        static_cast<std::uint64_t>(status.st_size) > most)
      return std::nullopt;
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(status.st_size));
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t got = ::read(fd_, bytes.data() + at, bytes.size() - at);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return std::nullopt;
      at += static_cast<std::size_t>(got);
    }
    return bytes;
  }

 private:
  int fd_;
};

std::string folder_of(const char* variable, const char* otherwise) {
  const char* set = std::getenv(variable);
  // A relative one is to be ignored, says the XDG specification.
  if (set != nullptr && set[0] == '/') return std::string(set) + "/dancegraph/avatars";
  const char* home = std::getenv("HOME");
  return std::string(home != nullptr && home[0] == '/' ? home : "/tmp") + otherwise +
         "/dancegraph/avatars";
}

Result<void> make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(fs::path(folder).parent_path(), error);
  if (mkdir(folder.c_str(), 0700) == 0) return {};
  if (errno != EEXIST) return fail("the folder of avatars " + folder + ": " + reason());
  return {};
}

// Written beside, and there under its name only when it is whole.
Result<void> write_whole(const std::string& path, const AvatarStore::Pieces& pieces) {
  const std::string beside = path + "." + std::to_string(getpid()) + std::string(kNewEnding);
  unlink(beside.c_str());
  {
    const File file(beside, O_WRONLY | O_CREAT | O_EXCL, 0600);
    if (!file.is_open()) return fail("the avatar " + beside + " cannot be written: " + reason());
    bool is_written = true;
    for (const auto piece : pieces) is_written = is_written && file.write(piece);
    if (!is_written || fsync(file.fd()) != 0) {
      const std::string why = reason();
      unlink(beside.c_str());
      return fail("the avatar " + path + " cannot be written: " + why);
    }
  }
  if (rename(beside.c_str(), path.c_str()) == 0) return {};
  const std::string why = reason();
  unlink(beside.c_str());
  return fail("the avatar " + path + " cannot be written: " + why);
}

std::string path_in(const std::string& folder, const FileHash& hash, std::string_view ending) {
  return folder + "/" + hex_of(hash) + std::string(ending);
}

std::string found_in(const std::string& folder, const FileHash& hash) {
  for (const std::string_view ending : kEndings) {
    std::string path = path_in(folder, hash, ending);
    struct stat status {};
    if (lstat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode)) return path;
  }
  return "";
}

std::string part_in(const std::string& folder, const GuestId& guest, const FileHash& hash) {
  return path_in(folder, hash, "." + std::string(guest.view()) + std::string(kPartEnding));
}

void mark_used(const std::string& path) { utimensat(AT_FDCWD, path.c_str(), nullptr, 0); }

}  // namespace

AvatarStore::AvatarStore(std::string own_folder, std::string foreign_folder,
                         std::size_t most_foreign_bytes)
    : own_(std::move(own_folder)),
      foreign_(std::move(foreign_folder)),
      most_foreign_bytes_(most_foreign_bytes) {}

AvatarStore AvatarStore::of_user() {
  return AvatarStore(folder_of("XDG_DATA_HOME", "/.local/share"),
                     folder_of("XDG_CACHE_HOME", "/.cache"));
}

std::string AvatarStore::find(const FileHash& hash) const {
  std::string path = found_in(own_, hash);
  if (!path.empty()) return path;
  path = found_in(foreign_, hash);
  if (!path.empty()) mark_used(path);
  return path;
}

// Removed only if all of it was read, is wrong, and can come again: never what a disk would not
// read just now, and never in the user's own folder.
std::optional<std::vector<std::uint8_t>> AvatarStore::read(const FileHash& hash) const {
  for (const std::string* folder : {&own_, &foreign_}) {
    const std::string path = found_in(*folder, hash);
    if (path.empty()) continue;
    const File file(path, O_RDONLY);
    if (!file.is_open()) continue;
    auto bytes = file.read(kMostFileBytes);
    if (!bytes) continue;
    if (sha256_of(*bytes) == hash) {
      if (folder == &foreign_) mark_used(path);
      return bytes;
    }
    if (folder == &foreign_) unlink(path.c_str());
  }
  return std::nullopt;
}

Result<AvatarStore::Kept> AvatarStore::read_file(const std::string& path) {
  // The user's own choice: it may be a link.
  std::error_code error;
  const std::string real = fs::canonical(path, error).string();
  const File file(error ? path : real, O_RDONLY);
  if (!file.is_open()) return fail("the avatar " + path + " cannot be opened: " + reason());
  struct stat status {};
  if (fstat(file.fd(), &status) != 0 || !S_ISREG(status.st_mode))
    return fail("the avatar " + path + " is not a file");
  if (static_cast<std::uint64_t>(status.st_size) > kMostFileBytes)
    return fail("the avatar " + path + " has " + std::to_string(status.st_size >> 20) +
                " MB; at most 16 travel to the others: make its pictures smaller, or JPEG");
  auto bytes = file.read(kMostFileBytes);
  if (!bytes || bytes->empty()) return fail("the avatar " + path + " is empty, or cannot be read");
  Kept kept;
  kept.hash = sha256_of(*bytes);
  kept.bytes = std::move(*bytes);
  return kept;
}

Result<void> AvatarStore::keep_own(const Kept& kept, bool is_vrm) const {
  std::string path = found_in(own_, kept.hash);
  if (!path.empty()) {
    const File file(path, O_RDONLY);
    const auto there = file.is_open() ? file.read(kMostFileBytes) : std::nullopt;
    if (there == kept.bytes) return {};
  } else {
    path = path_in(own_, kept.hash, kEndings[is_vrm ? 0 : 1]);
  }
  if (auto made = make_folder(own_); !made) return made;
  return write_whole(path, {kept.bytes});
}

Result<bool> AvatarStore::keep_foreign(const FileHash& hash, const Pieces& pieces,
                                       bool is_vrm) const {
  Sha256 sha256;
  std::size_t size = 0;
  for (const auto piece : pieces) {
    sha256.add(piece);
    size += piece.size();
  }
  if (size > kMostFileBytes || sha256.finish() != hash) return false;
  if (auto made = make_room(size); !made) return tl::make_unexpected(made.error());
  if (auto written = write_whole(path_in(foreign_, hash, kEndings[is_vrm ? 0 : 1]), pieces);
      !written)
    return tl::make_unexpected(written.error());
  return true;
}

// The longest unused of other houses go, and what was left half written.
Result<void> AvatarStore::make_room(std::size_t bytes) const {
  if (auto made = make_folder(foreign_); !made) return made;
  struct Entry {
    fs::path path;
    std::size_t size;
    fs::file_time_type used;
  };
  std::vector<Entry> entries;
  std::size_t sum = bytes;
  std::error_code error;
  for (const fs::directory_entry& it : folder_entries(foreign_, error)) {
    if (!it.is_regular_file(error)) continue;
    entries.push_back({it.path(), it.file_size(error), it.last_write_time(error)});
    sum += entries.back().size;
  }
  std::ranges::sort(entries, {}, &Entry::used);
  for (const Entry& entry : entries) {
    if (sum <= most_foreign_bytes_) break;
    fs::remove(entry.path, error);
    sum -= entry.size;
  }
  return {};
}

Result<void> AvatarStore::add_part(const GuestId& guest, const FileHash& hash, std::size_t offset,
                                   std::span<const std::uint8_t> bytes) const {
  if (offset + bytes.size() > kMostFileBytes) return fail("an avatar's part is too large");
  if (auto made = make_room(bytes.size()); !made) return made;
  const std::string path = part_in(foreign_, guest, hash);
  const File file(path, O_WRONLY | O_CREAT, 0600);
  struct stat status {};
  if (!file.is_open() || fstat(file.fd(), &status) != 0)
    return fail("the avatar " + path + " cannot be written: " + reason());
  // Only from the begin on: another process may have begun anew.
  if (status.st_size < static_cast<off_t>(offset)) return {};
  if (lseek(file.fd(), static_cast<off_t>(offset), SEEK_SET) < 0 || !file.write(bytes))
    return fail("the avatar " + path + " cannot be written: " + reason());
  return {};
}

std::vector<std::uint8_t> AvatarStore::part(const GuestId& guest, const FileHash& hash) const {
  const File file(part_in(foreign_, guest, hash), O_RDONLY);
  if (!file.is_open()) return {};
  return file.read(kMostFileBytes).value_or(std::vector<std::uint8_t>());
}

void AvatarStore::forget_part(const GuestId& guest, const FileHash& hash) const {
  unlink(part_in(foreign_, guest, hash).c_str());
}

std::vector<StoredAvatar> AvatarStore::list() const {
  std::vector<StoredAvatar> all;
  std::error_code error;
  for (const auto& [folder, is_own] : {std::pair(own_, true), std::pair(foreign_, false)}) {
    for (const fs::directory_entry& it : folder_entries(folder, error)) {
      const auto hash = parse_file_hash(it.path().stem().string());
      const std::string ending = it.path().extension().string();
      if (!hash || std::ranges::find(kEndings, ending) == kEndings.end() || it.is_symlink(error) ||
          !it.is_regular_file(error))
        continue;
      all.push_back({*hash, it.path().string(), it.file_size(error), is_own});
    }
  }
  std::ranges::sort(all, {}, &StoredAvatar::path);
  return all;
}

std::vector<std::string> shipped_avatars(const std::string& shipped_folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& it : folder_entries(shipped_folder, error))
    if (it.path().extension() == ".vrm" && GuestId::parse(it.path().stem().string()))
      names.push_back(it.path().stem().string());
  std::ranges::sort(names);
  return names;
}

}  // namespace dance
