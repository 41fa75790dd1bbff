// Fuzzes the bytes of a guest's profile that another house sends. The name of accepted bytes is
// valid, and writing it again gives the same bytes except for unknown signs.
#include "core/base/assert.h"
#include "tests/fuzz_target.h"
#include "tunnel/session/profile_bytes.h"

DANCE_FUZZ_TARGET(profile) {
  const auto read = dance::parse_profile({data, size});
  if (!read) return 0;
  const std::string_view name = read->shown_name.view();
  DANCE_ASSERT(name.size() <= dance::kMaxShownNameBytes && dance::is_plain_text(name));
  dance::ProfileBytes again;
  DANCE_ASSERT(dance::write_profile(*read, again) == size);
  DANCE_ASSERT(std::equal(data + 1, data + size, again.begin() + 1));
  return 0;
}
