// Fuzzes the bytes of a guest's chat that another house sends. All lines and signs of accepted
// bytes are valid, and writing them again gives the same bytes.
#include "core/base/assert.h"
#include "tests/fuzz_target.h"
#include "tunnel/wire/wire_chat.h"

DANCE_FUZZ_TARGET(chat) {
  const auto read = dance::wire::parse_chat({data, size});
  if (!read) return 0;
  DANCE_ASSERT(!read->entries.empty());
  for (const dance::Chat& chat : read->entries) DANCE_ASSERT(is_valid(chat));
  if (size > dance::wire::kMaxStatePayload) return 0;
  std::array<std::uint8_t, dance::wire::kMaxStatePayload> again;
  DANCE_ASSERT(dance::wire::build(*read, again) == size);
  DANCE_ASSERT(std::equal(data, data + size, again.begin()));
  return 0;
}
