// Modules of the programs: shared objects in lib/dancegraph beside the folder of the programs, in a
// build and in an installation. A program loads one when it first needs it, so that a library that
// brings many packages stays optional.
//
// A module exports one C function. It takes the hash of the interface that the program was built
// with, and returns a table of functions, or nullptr if the module was built with another.
//
// Ownership:    a loaded module stays until the program ends.
// Threads:      any may call these.
// Failure:      load_module() names the library that is missing, and how to install it.
#pragma once

#include <string>

#include "core/base/result.h"

namespace dance {

struct ProgramModule {
  const char* library;         // "FFmpeg"
  const char* package;         // "dancegraph-media"
  const char* cure;            // for a missing file
  const char* entry;           // the function, "dance_media_module_1"
  const char* interface_hash;  // that the program was built with
};

// "libdance_media.so" with its folder; "" if the folder of the programs is unknown.
std::string module_path(const std::string& file);
// The module's table.
Result<const void*> load_module(const std::string& path, const ProgramModule& module);

}  // namespace dance
