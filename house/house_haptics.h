// HouseHaptics: a device of a house's session that is to be felt to the millisecond: a
// dance-haptics program of its own beside the house, at real-time priority, which the house itself
// must not have. What `dance haptics set` tells it holds for its later starts too.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      as house/program/hosted_program.h. Where the house cannot hear what the program is
//               told, that is said, and a later start begins as its file has it.
#pragma once

#include <memory>
#include <string>

#include "core/net/program_control.h"
#include "house/program/hosted_program.h"
#include "house/session.h"

namespace dance {

class HouseHaptics {
 public:
  // `number` is another one for each of a house.
  HouseHaptics(const HostedHaptics& haptics, const std::string& bus, std::size_t number,
               Poller& poller);
  HouseHaptics(const HouseHaptics&) = delete;
  HouseHaptics& operator=(const HouseHaptics&) = delete;

 private:
  HostedProgram::Options program_options(const std::string& bus);
  void listen(std::size_t number, Poller& poller);
  void hear(std::string_view command);
  bool works(pid_t program);

  HostedHaptics haptics_;  // as it was told last
  std::string path_;       // of what haptics of this guest are told
  bool was_told_ = false;  // since the start
  std::unique_ptr<ProgramControl> control_;
  std::unique_ptr<HostedProgram> program_;
};

}  // namespace dance
