#include "house/program/program_words.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <utility>

namespace dance {
namespace {

constexpr std::size_t kLongestLine = 4096;
constexpr int kMostReads = 64;  // in one turn

void close_fd(int& fd) {
  if (fd >= 0) ::close(std::exchange(fd, -1));
}

}  // namespace

int ProgramWords::begin() {
  end();
  repeated_.start();
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return -1;
  read_fd_ = ends[0];
  write_fd_ = ends[1];
  ::fcntl(read_fd_, F_SETFL, O_NONBLOCK);
  poller_.watch(read_fd_, [this](MonoTime) { pass_on(); });
  return write_fd_;
}

void ProgramWords::started() { close_fd(write_fd_); }

void ProgramWords::end() {
  close_fd(write_fd_);
  if (read_fd_ >= 0) pass_on();
  if (!rest_.empty()) pass_on_line(std::exchange(rest_, {}));
  if (read_fd_ >= 0) poller_.unwatch(read_fd_);
  close_fd(read_fd_);
}

void ProgramWords::pass_on() {
  std::array<char, 1024> bytes{};
  for (int i = 0; i < kMostReads; ++i) {
    const ssize_t count = ::read(read_fd_, bytes.data(), bytes.size());
    if (count == 0) {
      // Its end: the pipe would be readable for ever.
      poller_.unwatch(read_fd_);
      return close_fd(read_fd_);
    }
    if (count < 0) return;
    rest_.append(bytes.data(), static_cast<std::size_t>(count));
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = rest_.find('\n', begin)) != std::string::npos; begin = end + 1)
      pass_on_line(std::string_view(rest_).substr(begin, end - begin));
    rest_.erase(0, begin);
    if (rest_.size() > kLongestLine) pass_on_line(std::exchange(rest_, {}));
  }
}

void ProgramWords::pass_on_line(std::string_view line) {
  if (!repeated_.is_new(line)) return;
  const std::string whole = std::string(line) + "\n";
  std::fwrite(whole.data(), 1, whole.size(), stderr);
}

}  // namespace dance
