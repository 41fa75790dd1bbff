// DANCE_ASSERT: for our own bugs, active in release builds too. Prints the condition, the place and
// up to two values, then aborts. Never used on data that came from outside.
//
// Threads: any.
// Failure: does not return.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace dance::detail {

[[noreturn]] inline void assertion_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, condition);
  std::abort();
}

template <class A>
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line, const A& a) {
  std::fprintf(stderr, "%s:%d: assertion failed: %s [%g]\n", file, line, condition,
               static_cast<double>(a));
  std::abort();
}

template <class A, class B>
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line, const A& a,
                                   const B& b) {
  std::fprintf(stderr, "%s:%d: assertion failed: %s [%g, %g]\n", file, line, condition,
               static_cast<double>(a), static_cast<double>(b));
  std::abort();
}

}  // namespace dance::detail

#define DANCE_ASSERT(condition, ...)                                          \
  do {                                                                        \
    if (!(condition)) [[unlikely]]                                            \
      ::dance::detail::assertion_failed(#condition, __FILE__,                 \
                                        __LINE__ __VA_OPT__(, ) __VA_ARGS__); \
  } while (false)
