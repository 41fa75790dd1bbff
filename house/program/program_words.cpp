#include "house/program/program_words.h"

#include <array>
#include <cstdio>
#include <utility>

namespace dance {
namespace {

constexpr std::size_t kLongestLine = 4096;
constexpr int kMostReads = 64;  // in one turn

}  // namespace

int ProgramWords::begin() {
  end();
  repeated_.start();
  auto opened = ChildPipe::open();
  if (!opened) return -1;
  pipe_ = std::move(*opened);
  poller_.watch(pipe_.fd(), [this](MonoTime) { pass_on(); });
  return pipe_.child_fd();
}

void ProgramWords::end() {
  pipe_.let_go();
  if (pipe_.is_open()) pass_on();
  if (!rest_.empty()) pass_on_line(rest_);
  rest_.clear();
  close();
}

void ProgramWords::close() {
  if (pipe_.is_open()) poller_.unwatch(pipe_.fd());
  pipe_.close();
}

void ProgramWords::pass_on() {
  std::array<char, 1024> bytes{};
  for (int i = 0; i < kMostReads; ++i) {
    const auto count = pipe_.read(bytes);
    if (!count) return close();  // it would be readable for ever
    if (*count == 0) return;
    rest_.append(bytes.data(), *count);
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = rest_.find('\n', begin)) != std::string::npos; begin = end + 1)
      pass_on_line(std::string_view(rest_).substr(begin, end - begin));
    rest_.erase(0, begin);
    if (rest_.size() > kLongestLine) {
      pass_on_line(rest_);
      rest_.clear();
    }
  }
}

void ProgramWords::pass_on_line(std::string_view line) {
  if (!repeated_.is_new(line)) return;
  const std::string whole = std::string(line) + "\n";
  std::fwrite(whole.data(), 1, whole.size(), stderr);
}

}  // namespace dance
