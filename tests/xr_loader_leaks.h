// OpenXR's loader 1.0.20 keeps what it made for each instance: in one source of each test program
// that loads it, so that the address sanitizer reports leaks of ours alone.
//
// Units/frames: none.
// Ownership:    none.
// Threads:      none inside.
// Failure:      none.
#pragma once

// NOLINTNEXTLINE(bugprone-reserved-identifier): the sanitizer's own name.
extern "C" inline __attribute__((used)) const char* __lsan_default_suppressions() {
  return "leak:libopenxr_loader\n";
}
