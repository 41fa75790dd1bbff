// Fuzz targets of a program. DANCE_FUZZ_TARGET(name) { … } defines one: the body is called with
// each input as `data` and `size`, returns 0, and aborts on a fault. One program has the targets of
// a folder: the environment's DANCE_FUZZ_TARGET (libFuzzer) or the first argument (replay) selects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace dance {

class FuzzTarget {
 public:
  using Run = int (*)(const std::uint8_t* data, std::size_t size);

  // `name` lives as long as the program.
  FuzzTarget(const char* name, Run run);
  FuzzTarget(const FuzzTarget&) = delete;
  FuzzTarget& operator=(const FuzzTarget&) = delete;

  // The target of that name; where there is none, prints the names to stderr and ends the program
  // with exit 2.
  static Run find(std::string_view name);

 private:
  const char* name_;
  Run run_;
  const FuzzTarget* next_;
};

}  // namespace dance

#define DANCE_FUZZ_TARGET(name)                                            \
  static int fuzz_##name(const std::uint8_t* data, std::size_t size);      \
  static const ::dance::FuzzTarget fuzz_target_##name(#name, fuzz_##name); \
  static int fuzz_##name(const std::uint8_t* data, std::size_t size)
