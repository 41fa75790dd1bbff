// Any bytes as an LCM log: every event lies within them, all bytes are accounted for, and reading
// ends.
#include <cstdint>

#include "core/base/assert.h"
#include "formats/log/log_file.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(log_file) {
  dance::LogReader reader = dance::LogReader::over({data, size});
  std::size_t used = 0;
  unsigned sum = 0;
  while (const auto event = reader.next()) {
    DANCE_ASSERT(!event->channel.empty() && event->channel.size() <= 63, event->channel.size());
    used += 28 + event->channel.size() + event->data.size();
    for (const char c : event->channel) sum += static_cast<unsigned char>(c);
    for (const std::uint8_t byte : event->data) sum += byte;
  }
  DANCE_ASSERT(used + reader.skipped_bytes() == size, used, size);
  // The sum touches every byte that was handed out; the sanitizer sees one that is not ours.
  return sum == 0xffffffffu ? 1 : 0;
}
