#include "core/program/child_pipe.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace dance {
namespace {

void close_end(int& fd) {
  if (fd >= 0) ::close(std::exchange(fd, -1));
}

}  // namespace

Result<ChildPipe> ChildPipe::open() {
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    return fail("no pipe can be had; is this user out of open files?");
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  ChildPipe pipe;
  pipe.fd_ = ends[0];
  pipe.child_fd_ = ends[1];
  return pipe;
}

void ChildPipe::let_go() { close_end(child_fd_); }

std::optional<std::size_t> ChildPipe::read(std::span<char> into) {
  if (fd_ < 0) return std::nullopt;
  for (;;) {
    const ssize_t count = ::read(fd_, into.data(), into.size());
    if (count > 0) return static_cast<std::size_t>(count);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return 0;
    return std::nullopt;
  }
}

void ChildPipe::close() {
  close_end(fd_);
  close_end(child_fd_);
}

}  // namespace dance
