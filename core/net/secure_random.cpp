#include "core/net/secure_random.h"

#include <sys/random.h>

#include "core/base/assert.h"

namespace dance {

std::uint64_t secure_random_u64() {
  std::uint64_t value = 0;
  const ssize_t got = getrandom(&value, sizeof value, 0);
  DANCE_ASSERT(got == sizeof value, got);
  return value;
}

}  // namespace dance
