#include "lobby/run/child_words.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/printable.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

// What is there, in turns of one buffer, at most so many.
template <class Use>
void drain(ChildPipe& pipe, Use use) {
  std::array<char, 4096> bytes{};
  for (int turn = 0; turn < 64; ++turn) {
    const std::size_t count = pipe.read(bytes).value_or(0);
    if (count == 0) return;
    use(std::string_view(bytes.data(), count));
  }
}

}  // namespace

std::string_view without_prefix(std::string_view line) {
  const std::string_view words = talk::without_time(line);
  const std::size_t colon = words.find(": ");
  return words.size() == line.size() || colon == std::string_view::npos ? line
                                                                        : words.substr(colon + 2);
}

Result<ChildWords> ChildWords::start(const std::string& program, std::vector<std::string> arguments,
                                     bool takes_output) {
  DANCE_TRY(ChildPipe words, ChildPipe::open());
  ChildPipe output;
  if (takes_output) {
    DANCE_TRY(output, ChildPipe::open());
  }
  ChildProcess::Options options;
  options.program = program_folder() + "/" + program;
  options.arguments = std::move(arguments);
  options.talk_fd = words.child_fd();
  options.output_fd = output.child_fd();
  DANCE_TRY(ChildProcess process, ChildProcess::start(options));
  words.let_go();
  output.let_go();
  return ChildWords(std::move(process), std::move(words), std::move(output));
}

bool ChildWords::read() {
  const std::size_t before = fresh_;
  // Asked first: what it said before its end is read then.
  const bool has_ended = process_.has_ended();
  drain(words_, [&](std::string_view bytes) { add(bytes); });
  drain(output_pipe_, [&](std::string_view bytes) {
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
