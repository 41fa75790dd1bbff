#include "formats/engine/shared_memory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "core/base/assert.h"

namespace dance::engine {
namespace {

constexpr auto kBytes = static_cast<off_t>(sizeof(Segment));
constexpr int kOpenTries = 16;

std::string error_text(int error) {
  std::array<char, 128> text{};
  return strerror_r(error, text.data(), text.size());
}

std::string shown(const MemoryName& name) {
  return "shared memory '" + std::string(name.view()) + "'";
}

// Closes what it holds, unless it is taken out.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  int take() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

bool is_ours(const struct stat& found) {
  return S_ISREG(found.st_mode) && found.st_uid == ::geteuid();
}

// /dev/shm is everybody's: what another user put there under our name may be a FIFO, whose opening
// would wait for its other end.
Descriptor open_memory(const MemoryName& name, int flags) {
  return Descriptor(::shm_open(name.c_str(), flags | O_CLOEXEC | O_NONBLOCK, 0600));
}

// 0, or why not.
int lock_at_once(int fd) {
  while (::flock(fd, LOCK_EX | LOCK_NB) != 0)
    if (errno != EINTR) return errno;
  return 0;
}

int reserve(int fd) {
  for (;;)
    if (const int error = ::posix_fallocate(fd, 0, kBytes); error != EINTR) return error;
}

// Whether the name still leads to what was opened: another house may have ended and removed it.
bool is_still_named(const MemoryName& name, const struct stat& opened) {
  const Descriptor again = open_memory(name, O_RDONLY);
  struct stat found {};
  return again.get() >= 0 && ::fstat(again.get(), &found) == 0 && found.st_ino == opened.st_ino &&
         found.st_dev == opened.st_dev;
}

Result<Segment*> map_to_write(const MemoryName& name, int fd) {
  // Before anything is written: what is not there would end this process later.
  if (const int error = reserve(fd); error != 0)
    return fail(shown(name) + " needs " + std::to_string(kBytes / 1024) +
                " kB: " + error_text(error) + "; make room in /dev/shm");
  void* memory = ::mmap(nullptr, sizeof(Segment), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (memory == MAP_FAILED) return fail(shown(name) + " cannot be mapped: " + error_text(errno));
  return static_cast<Segment*>(memory);
}

}  // namespace

MemoryName memory_name(const GuestId& name) {
  MemoryName text;
  const bool fits =
      text.assign("/dance-engine-" + std::to_string(::geteuid()) + "-" + std::string(name.view()));
  DANCE_ASSERT(fits);
  return text;
}

Result<std::unique_ptr<OwnedSegment>> OwnedSegment::open(const GuestId& name) {
  const MemoryName path = memory_name(name);
  for (int i = 0; i < kOpenTries; ++i) {
    Descriptor fd = open_memory(path, O_RDWR | O_CREAT);
    if (fd.get() < 0)
      return fail(shown(path) + " cannot be had: " + error_text(errno) +
                  "; choose another name, or remove it from /dev/shm");
    struct stat found {};
    if (::fstat(fd.get(), &found) != 0 || !is_ours(found))
      return fail(shown(path) + " is not this user's: choose another name");
    const int locked = lock_at_once(fd.get());
    if (locked != 0 && locked != EWOULDBLOCK)
      return fail(shown(path) + " cannot be locked: " + error_text(locked));
    // Also where the lock is that of a house which is ending, and has removed the name already.
    if (!is_still_named(path, found)) continue;
    if (locked != 0)
      return fail("another house shows its stage to engines as '" + std::string(name.view()) +
                  "': end it, or give one of the two another name");
    // Never cut off: a reader would fall out of what it has mapped.
    if (found.st_size != 0 && found.st_size != kBytes) {
      ::shm_unlink(path.c_str());
      continue;
    }
    if (::fchmod(fd.get(), 0600) != 0)
      return fail(shown(path) + " cannot be closed to others: " + error_text(errno));
    DANCE_TRY(Segment * segment, map_to_write(path, fd.get()));
    return std::unique_ptr<OwnedSegment>(new OwnedSegment(path, fd.take(), segment));
  }
  return fail(shown(path) + " is made and removed all the time: end the other houses");
}

OwnedSegment::~OwnedSegment() {
  // The name first, while the lock is held: it is still this one's.
  ::shm_unlink(name_.c_str());
  ::munmap(segment_, sizeof(Segment));
  ::close(fd_);
}

SeenSegment::Look SeenSegment::look() {
  const Descriptor fd = open_memory(name_, O_RDONLY);
  if (fd.get() < 0) return Look::kNothing;
  struct stat found {};
  if (::fstat(fd.get(), &found) != 0 || !is_ours(found)) return Look::kDamaged;
  if (segment_ && found.st_ino == inode_ && found.st_dev == device_) return Look::kSame;
  if (found.st_size == 0) return Look::kNothing;  // being made
  struct {
    std::uint64_t magic;
    std::uint32_t version;
  } head{};
  if (::pread(fd.get(), &head, sizeof head, 0) != static_cast<ssize_t>(sizeof head))
    return Look::kDamaged;
  if (head.magic == 0) return Look::kNothing;
  if (head.magic != kMagic) return Look::kDamaged;
  if (head.version != kVersion) return Look::kWrongVersion;
  if (found.st_size != kBytes) return Look::kDamaged;
  void* memory = ::mmap(nullptr, sizeof(Segment), PROT_READ, MAP_SHARED, fd.get(), 0);
  if (memory == MAP_FAILED) return Look::kNothing;
  forget();
  segment_ = static_cast<const Segment*>(memory);
  device_ = found.st_dev;
  inode_ = found.st_ino;
  return Look::kNew;
}

void SeenSegment::forget() {
  if (segment_) ::munmap(const_cast<Segment*>(segment_), sizeof(Segment));
  segment_ = nullptr;
}

}  // namespace dance::engine
