// Any bytes are a session or an error that names a place; never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "house/session.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(session) {
  const auto session =
      dance::parse_session({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
  if (!session && session.error().what.rfind("fuzz.toml:", 0) != 0) std::abort();
  if (session && session->routes.empty()) std::abort();
  return 0;
}
