// Result<T>: a value, or one line that names the thing that failed and the cure. For errors of the
// environment (a file missing, a port taken); main prints the line and picks the exit code.
//
// Threads: none inside.
// Failure: Error is the failure.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace dance {

struct Error {
  std::string what;  // one line, no full stop: the thing, the reason, the cure
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(std::string what) {
  return tl::make_unexpected(Error{std::move(what)});
}

}  // namespace dance

#define DANCE_CONCAT_INNER(a, b) a##b
#define DANCE_CONCAT(a, b) DANCE_CONCAT_INNER(a, b)

// DANCE_TRY(auto value, expression): value of the Result, or return its error from here.
// NOLINTBEGIN(bugprone-macro-parentheses): a declaration cannot stand in parentheses.
#define DANCE_TRY(declaration, expression)                                               \
  auto DANCE_CONCAT(dance_try_, __LINE__) = (expression);                                \
  if (!DANCE_CONCAT(dance_try_, __LINE__))                                               \
    return ::tl::make_unexpected(std::move(DANCE_CONCAT(dance_try_, __LINE__)).error()); \
  declaration = std::move(*DANCE_CONCAT(dance_try_, __LINE__))
// NOLINTEND(bugprone-macro-parentheses)
