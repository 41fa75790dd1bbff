#include "lobby/run/child_words.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/printable.h"
#include "core/program/program.h"

namespace dance {
namespace {

struct Pipe {
  int read_fd = -1;
  int write_fd = -1;

  Pipe() {
    std::array<int, 2> ends{-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return;
    read_fd = ends[0];
    write_fd = ends[1];
    fcntl(read_fd, F_SETFL, O_NONBLOCK);
  }
  ~Pipe() {
    if (read_fd >= 0) close(read_fd);
    if (write_fd >= 0) close(write_fd);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int take_read_fd() { return std::exchange(read_fd, -1); }
};

bool is_time(std::string_view word) {
  return word.size() == 12 && word[2] == ':' && word[5] == ':' && word[8] == '.';
}

// What is there, in turns of one buffer, at most so many.
template <class Use>
void drain(int fd, Use use) {
  std::array<char, 4096> bytes{};
  for (int turn = 0; fd >= 0 && turn < 64; ++turn) {
    const ssize_t count = ::read(fd, bytes.data(), bytes.size());
    if (count <= 0) return;
    use(std::string_view(bytes.data(), static_cast<std::size_t>(count)));
  }
}

}  // namespace

std::string_view without_prefix(std::string_view line) {
  const std::size_t space = line.find(' ');
  if (space == std::string_view::npos || !is_time(line.substr(0, space))) return line;
  const std::size_t colon = line.find(": ", space);
  return colon == std::string_view::npos ? line : line.substr(colon + 2);
}

Result<ChildWords> ChildWords::start(const std::string& program, std::vector<std::string> arguments,
                                     bool takes_output) {
  Pipe words, output;
  if (words.read_fd < 0 || output.read_fd < 0)
    return fail("no pipe can be had; is this user out of open files?");
  ChildProcess::Options options;
  options.program = program_folder() + "/" + program;
  options.arguments = std::move(arguments);
  options.talk_fd = words.write_fd;
  if (takes_output) options.output_file = "/proc/self/fd/" + std::to_string(output.write_fd);
  DANCE_TRY(ChildProcess process, ChildProcess::start(options));
  ChildWords started(std::move(process));
  started.words_fd_ = words.take_read_fd();
  if (takes_output) started.output_fd_ = output.take_read_fd();
  return started;
}

ChildWords::~ChildWords() { close_pipes(); }

ChildWords::ChildWords(ChildWords&& other) noexcept
    : process_(std::move(other.process_)),
      words_fd_(std::exchange(other.words_fd_, -1)),
      output_fd_(std::exchange(other.output_fd_, -1)),
      has_told_end_(other.has_told_end_),
      rest_(std::move(other.rest_)),
      lines_(std::move(other.lines_)),
      fresh_(other.fresh_),
      output_(std::move(other.output_)) {}

ChildWords& ChildWords::operator=(ChildWords&& other) noexcept {
  if (this == &other) return *this;
  close_pipes();
  process_ = std::move(other.process_);
  words_fd_ = std::exchange(other.words_fd_, -1);
  output_fd_ = std::exchange(other.output_fd_, -1);
  has_told_end_ = other.has_told_end_;
  rest_ = std::move(other.rest_);
  lines_ = std::move(other.lines_);
  fresh_ = other.fresh_;
  output_ = std::move(other.output_);
  return *this;
}

void ChildWords::close_pipes() {
  for (int* fd : {&words_fd_, &output_fd_})
    if (*fd >= 0) ::close(std::exchange(*fd, -1));
}

bool ChildWords::read() {
  const std::size_t before = fresh_;
  // Asked first: what it said before its end is read then.
  const bool has_ended = process_.has_ended();
  drain(words_fd_, [&](std::string_view bytes) { add(bytes); });
  drain(output_fd_, [&](std::string_view bytes) {
    output_.append(
        bytes.substr(0, kMostOutput_bytes - std::min(output_.size(), kMostOutput_bytes)));
  });
  if (has_ended && !rest_.empty()) add_line(std::exchange(rest_, ""));
  const bool is_end_new = has_ended && !std::exchange(has_told_end_, has_ended);
  return fresh_ != before || is_end_new;
}

void ChildWords::add(std::string_view bytes) {
  for (const char c : bytes) {
    if (c == '\n')
      add_line(std::exchange(rest_, ""));
    else if (rest_.size() < kMostLine_bytes)
      rest_ += c;
  }
}

void ChildWords::add_line(std::string_view line) {
  lines_.push_back(printable(without_prefix(line)));
  fresh_ = std::min(fresh_ + 1, kMostLines);
  if (lines_.size() > kMostLines) lines_.pop_front();
}

std::vector<std::string> ChildWords::take_lines() {
  std::vector<std::string> taken(lines_.end() - static_cast<std::ptrdiff_t>(fresh_), lines_.end());
  fresh_ = 0;
  return taken;
}

}  // namespace dance
