// HostedProgram: a program that a house runs beside itself, started again when it ends: what its
// devices do is nothing to the dancers.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      nothing ends the house. What the program cannot have it says itself, once; it is
//               tried again at each pause, also where it could not be started, and that it works
//               again is said too. One that died is started again after a second, or where it does
//               so again and again after longer and longer pauses. Wrong use (exit 2) and an end
//               without an error (0) are for good.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/net/poller.h"
#include "core/program/child_process.h"
#include "house/program/program_words.h"

namespace dance {

class HostedProgram {
 public:
  struct Options {
    std::string path;
    std::string name;     // in lines for people, as "dance voice"
    std::string without;  // how the house goes on, as "without voices"
    // Of each start.
    std::function<std::vector<std::string>()> arguments;
    // Whether what runs since `started` has all that it needs, by a sign of its own; asked until it
    // has.
    std::function<bool(pid_t program, MonoTime started)> works;
    Duration pause = Duration::s(10);       // before another start, at most
    Duration first_pause = Duration::s(1);  // before the next start of one that died
    Duration look = Duration::ms(200);
    bool starts = true;  // else only set_wanted() starts it
  };

  HostedProgram(Options options, Poller& poller);
  ~HostedProgram();
  HostedProgram(const HostedProgram&) = delete;
  HostedProgram& operator=(const HostedProgram&) = delete;

  // Starts the program, also one that is not started again by itself, or ends it. Waits for
  // neither.
  void set_wanted(bool is_wanted);
  bool is_wanted() const { return is_wanted_; }
  // It has ended without an error, and is not started again.
  bool has_finished() const { return has_finished_; }

 private:
  MonoTime start(MonoTime now);
  MonoTime look(MonoTime now);
  MonoTime wait_for_end(MonoTime now);
  void note_that_it_works();
  // Says it where it is not what was said last.
  MonoTime try_later(const std::string& trouble, MonoTime now);
  MonoTime start_after_death(const std::string& end, MonoTime now);

  Options options_;
  Poller& poller_;
  ProgramWords words_;
  std::unique_ptr<ChildProcess> program_;
  MonoTime started_;
  Duration pause_;  // before the start after the newest death
  bool works_ = false, has_finished_ = false;
  bool is_wanted_ = false;
  MonoTime asked_to_end_;  // not set: it was not
  std::string trouble_;    // that was said; "" once it has worked
  Poller::TimerId timer_ = 0;
};

}  // namespace dance
