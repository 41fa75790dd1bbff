// A program that the system may have, run to its end.
//
// Units/frames: none.
// Ownership:    nothing stays.
// Threads:      one; waits until the program has ended.
// Failure:      an Error says that the program is missing and which package has it, or how it
//               ended.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

struct OutsideProgram {
  std::string name;
  std::string package;
  std::vector<std::string> arguments;
  std::string output_file;  // where its stdout goes
  std::string talk_file;    // where its stderr goes
};

Result<void> run_outside_program(const OutsideProgram& wanted);

}  // namespace dance
