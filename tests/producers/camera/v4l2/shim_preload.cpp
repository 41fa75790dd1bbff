// The functions of the C library that dance_video_shim answers in place of the kernel. All that is
// not about its device goes on to the next library.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>

#include "tests/producers/camera/v4l2/shim_device.h"

namespace {

template <class Function>
Function* next_of(Function*, const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

// Sanitizers call these before they are ready for anybody's memory or locks: nothing is touched
// until a camera is opened.
bool is_ours(int fd) {
  return dance::ShimDevice::open_handles() > 0 && dance::ShimDevice::here().is_ours(fd);
}

int open_ours_or(const char* name, const char* path, int flags, mode_t mode) {
  if (dance::ShimDevice::is_video(path)) {
    const int ours = dance::ShimDevice::here().open(path, flags);
    if (ours != -2) return ours;
  }
  using Open = int(const char*, int, ...);
  static Open* const next = next_of(static_cast<Open*>(nullptr), name);
  return next(path, flags, mode);
}

mode_t mode_of(int flags, va_list more) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
}

}  // namespace

extern "C" {

dance::VideoShim* dance_video_shim() { return &dance::ShimDevice::here(); }

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_ours_or("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_ours_or("open64", path, flags, mode);
}

int close(int fd) {
  if (is_ours(fd)) dance::ShimDevice::here().close(fd);
  static auto* const next = next_of(&close, "close");
  return next(fd);
}

int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list more;
  va_start(more, request);
  void* argument = va_arg(more, void*);
  va_end(more);
  if (is_ours(fd)) {
    const int number = dance::ShimDevice::here().answer(fd, request, argument);
    if (number == 0) return 0;
    errno = number;
    return -1;
  }
  using Ioctl = int(int, unsigned long, ...);
  static Ioctl* const next = next_of(static_cast<Ioctl*>(nullptr), "ioctl");
  return next(fd, request, argument);
}

void* mmap(void* at, size_t size, int protection, int flags, int fd, off_t offset) noexcept {
  static auto* const next = next_of(&mmap, "mmap");
  if (fd >= 0 && dance::ShimDevice::open_handles() > 0) {
    const int memory = dance::ShimDevice::here().memory_of(fd);
    if (memory >= 0) fd = memory;
  }
  return next(at, size, protection, flags, fd, offset);
}

void* mmap64(void* at, size_t size, int protection, int flags, int fd, off64_t offset) noexcept {
  return mmap(at, size, protection, flags, fd, offset);
}

}  // extern "C"
