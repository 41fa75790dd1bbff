// ProgramWords: what a program that this house has started says on its stderr, passed on to ours
// line by line, but for what it repeats from start to start.
//
// Units/frames: bytes.
// Ownership:    owns a pipe while the program runs; refers to the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      without a pipe the program talks to our stderr directly, repeated lines too.
#pragma once

#include <string>

#include "core/net/poller.h"
#include "core/program/child_pipe.h"
#include "house/program/repeated_words.h"

namespace dance {

class ProgramWords {
 public:
  explicit ProgramWords(Poller& poller) : poller_(poller) {}
  ~ProgramWords() { end(); }
  ProgramWords(const ProgramWords&) = delete;
  ProgramWords& operator=(const ProgramWords&) = delete;

  // Before a start: where the program's stderr goes, -1 for ours.
  int begin();
  // After it: this process talks to the pipe no more.
  void started() { pipe_.let_go(); }
  // The program has ended: what it said last is passed on.
  void end();
  // It worked: what it says of a later failure is news.
  void forget() { repeated_.forget(); }

 private:
  void close();
  void pass_on();
  void pass_on_line(std::string_view line);

  Poller& poller_;
  RepeatedWords repeated_;
  ChildPipe pipe_;
  std::string rest_;  // of a line that has no end yet
};

}  // namespace dance
