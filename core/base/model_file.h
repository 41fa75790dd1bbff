// What all files of trained models have in common: how they begin, and what is said of one that is
// another file, of another version or damaged.
//
// Units/frames: a file begins with a magic number (u32) and a version (u16), little-endian.
// Ownership:    refers to texts that last as long as the program.
// Threads:      any.
// Failure:      read_head() and damaged() say what is wrong and the command that makes a new file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/byte_reader.h"
#include "core/base/result.h"

namespace dance {

struct ModelFileKind {
  std::uint32_t magic;
  std::uint16_t version;
  const char* of;       // "prediction"
  const char* command;  // that trains it: "dance predict train"

  Result<void> read_head(ByteReader& in) const {
    if (in.u32() != magic)
      return fail(std::string("this is not a model of ") + of + ": make one with " + command);
    const std::uint16_t found = in.u16();
    if (found != version)
      return fail("the model is of version " + std::to_string(found) +
                  ", this build reads version " + std::to_string(version) +
                  ": train it again with " + command);
    return {};
  }

  tl::unexpected<Error> damaged(std::size_t bytes) const {
    return fail("the model is damaged (" + std::to_string(bytes) +
                " bytes): fetch it again, or train it with " + command);
  }
};

}  // namespace dance
