// ChildWords: a program that the window runs, and what it says: the last lines of its stderr, and,
// where that is wanted, its stdout.
//
// Units/frames: bytes.
// Ownership:    owns the program, which ends with it, and the pipes' ends.
// Threads:      none inside; read() never waits.
// Failure:      start() names the program and the reason; beyond kMostLines the oldest lines go,
//               and output beyond kMostOutput_bytes is left out.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "core/program/child_pipe.h"
#include "core/program/child_process.h"

namespace dance {

class ChildWords {
 public:
  static constexpr std::size_t kMostLines = 60, kMostLine_bytes = 400;
  static constexpr std::size_t kMostOutput_bytes = 1 << 20;

  // `program` as `dance-join`, beside this one.
  static Result<ChildWords> start(const std::string& program, std::vector<std::string> arguments,
                                  bool takes_output = false);

  // Takes what has come. True where there is a new line, or the program has ended.
  bool read();
  // Lines that were not taken yet, without time and name of the program.
  std::vector<std::string> take_lines();
  const std::deque<std::string>& lines() const { return lines_; }
  std::string last_line() const { return lines_.empty() ? "" : lines_.back(); }
  const std::string& output() const { return output_; }
  ChildProcess& process() { return process_; }

 private:
  ChildWords(ChildProcess process, ChildPipe words, ChildPipe output)
      : process_(std::move(process)), words_(std::move(words)), output_pipe_(std::move(output)) {}
  void add(std::string_view bytes);
  void add_line(std::string_view line);

  ChildProcess process_;
  ChildPipe words_, output_pipe_;  // end before the program, which then has nobody to write to
  bool has_told_end_ = false;
  std::string rest_;  // of a line that has no end yet
  std::deque<std::string> lines_;
  std::size_t fresh_ = 0;
  std::string output_;
};

// "12:00:00.000 dance join: the house is open" → "the house is open".
std::string_view without_prefix(std::string_view line);

}  // namespace dance
