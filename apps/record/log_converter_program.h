// What `dance pack` and `dance unpack` have in common: all but the direction and the words.
//
// Units/frames: none.
// Ownership:    refers to nothing after the call.
// Threads:      call from main.
// Failure:      as run_program(): one line and the exit code.
#pragma once

#include "apps/record/log_converter.h"

namespace dance {

struct LogConverterWords {
  const char* purpose;
  const char* name;
  const char* file;  // what the input is
  const char* examples;
};

int run_log_converter(LogForm form, const LogConverterWords& words, int argc, char** argv);

}  // namespace dance
