#include "tunnel/seal/keys/key_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/net/secure_random.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargest = 2'000'000;

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

std::string reason() { return std::strerror(errno); }

Result<std::string> make_folder_of(const std::string& path) {
  std::string folder = fs::path(path).parent_path().string();
  std::error_code error;
  if (!folder.empty() && !fs::exists(folder, error)) {
    fs::create_directories(folder, error);
    if (error) return fail(folder + ": cannot be made: " + error.message());
    fs::permissions(folder, fs::perms::owner_all, error);
  }
  return folder;
}

// A whole file of its own beside `path`, for its owner alone; its name.
Result<std::string> write_beside(const std::string& path, const std::string& text) {
  DANCE_TRY(const std::string folder, make_folder_of(path));
  const std::string beside = path + "." + std::to_string(secure_random_u64()) + ".new";
  const Descriptor file(open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (file.get() < 0)
    return fail(path + ": cannot be written: " + reason() + "; is the folder yours?");
  // Root adds a key for a service: it is the service's to read.
  struct stat about {};
  if (geteuid() == 0 && !folder.empty() && stat(folder.c_str(), &about) == 0 &&
      fchown(file.get(), about.st_uid, about.st_gid) != 0) {
    const std::string why = reason();
    unlink(beside.c_str());
    return fail(path + ": cannot be given to the owner of its folder: " + why);
  }
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t size = write(file.get(), text.data() + written, text.size() - written);
    if (size <= 0) {
      const std::string why = reason();
      unlink(beside.c_str());
      return fail(path + ": cannot be written: " + why + "; is the disk full?");
    }
    written += static_cast<std::size_t>(size);
  }
  fsync(file.get());
  return beside;
}

}  // namespace

Result<std::string> key_folder() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && config[0] == '/') return std::string(config) + "/dance";
  const char* home = std::getenv("HOME");
  if (home != nullptr && home[0] == '/') return std::string(home) + "/.config/dance";
  return fail("there is no place for keys: set HOME or XDG_CONFIG_HOME to a folder of yours");
}

Result<std::optional<std::string>> read_secret(const std::string& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK));
  if (file.get() < 0) {
    if (errno == ENOENT) return std::optional<std::string>();
    return fail(path + ": cannot be read: " + reason());
  }
  struct stat about {};
  if (fstat(file.get(), &about) != 0 || !S_ISREG(about.st_mode))
    return fail(path + " is no file; keys are kept in one");
  if ((about.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    return fail(path + " holds secrets and can be read by other users; run: chmod 600 " + path);
  std::string text;
  std::array<char, 4096> part;
  for (;;) {
    const ssize_t size = read(file.get(), part.data(), part.size());
    if (size < 0) return fail(path + ": cannot be read: " + reason());
    if (size == 0) return std::optional(std::move(text));
    text.append(part.data(), static_cast<std::size_t>(size));
    if (text.size() > kLargest) return fail(path + " is larger than any file of keys");
  }
}

Result<void> write_secret(const std::string& path, const std::string& text) {
  DANCE_TRY(const std::string beside, write_beside(path, text));
  if (rename(beside.c_str(), path.c_str()) == 0) return {};
  const std::string why = reason();
  unlink(beside.c_str());
  return fail(path + ": cannot be written: " + why);
}

Result<FileLock> FileLock::of_folder(const std::string& path) {
  DANCE_TRY(std::string folder, make_folder_of(path));
  if (folder.empty()) folder = ".";
  return take(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC), folder);
}

Result<FileLock> FileLock::of_file(const std::string& path) {
  if (auto folder = make_folder_of(path); !folder) return tl::make_unexpected(folder.error());
  return take(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOCTTY, 0600), path);
}

Result<FileLock> FileLock::take(int fd, const std::string& name) {
  if (fd < 0) return fail(name + ": cannot be opened to lock it: " + reason() + "; is it yours?");
  FileLock lock(fd);
  while (flock(fd, LOCK_EX) != 0)
    if (errno != EINTR)
      return fail(name + ": cannot be locked: " + reason() +
                  "; keep keys on a disk of this machine");
  return lock;
}

FileLock::~FileLock() {
  if (fd_ >= 0) close(fd_);
}

namespace {

// The key in a file; the first program that needs it makes it.
template <class Key>
Result<Key> read_or_make(const std::string& path) {
  for (int i = 0; i < 2; ++i) {
    DANCE_TRY(const auto text, read_secret(path));
    if (text) {
      const auto key = Key::parse(std::string_view(*text).substr(0, text->find('\n')));
      if (!key)
        return fail(path +
                    " holds no key: restore it from a backup, or remove it, and the next program "
                    "makes another");
      return *key;
    }
    // The first process to create the link wins; the others use its file.
    DANCE_TRY(const std::string beside, write_beside(path, Key::make().text() + "\n"));
    const bool is_there = link(beside.c_str(), path.c_str()) == 0 || errno == EEXIST;
    const std::string why = reason();
    unlink(beside.c_str());
    if (!is_there) return fail(path + ": cannot be made: " + why);
  }
  return fail(path + " comes and goes; is another program removing it?");
}

}  // namespace

Result<PresharedKey> local_key() {
  DANCE_TRY(const std::string folder, key_folder());
  return read_or_make<PresharedKey>(folder + "/" + kLocalKeyName + ".key");
}

Result<PrivateKey> house_identity(std::string folder) {
  if (folder.empty()) {
    DANCE_TRY(folder, key_folder());
  }
  return read_or_make<PrivateKey>(folder + "/identity.key");
}

std::string server_identity_path(const std::string& keys_path) {
  return (fs::path(keys_path).parent_path() / "server-identity.key").string();
}

Result<PrivateKey> server_identity(const std::string& keys_path) {
  return read_or_make<PrivateKey>(server_identity_path(keys_path));
}

Result<KeyRing> load_server_keys(const std::string& path) {
  DANCE_TRY(const auto text, read_secret(path));
  return text ? KeyRing::parse(*text, path) : KeyRing();
}

Result<KeyRing> with_local_key(KeyRing ring) {
  KeyEntry entry;
  entry.name = *GuestId::parse(kLocalKeyName);
  entry.kind = KeyKind::kRoom;
  DANCE_TRY(entry.local_key, local_key());
  ring.remove(kLocalKeyName);
  ring.add(entry);
  return ring;
}

}  // namespace dance
