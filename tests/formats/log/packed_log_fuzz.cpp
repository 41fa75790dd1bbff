// Any bytes as a packed log: reading ends, and whatever events there are, packed or not, come back
// from being packed.
#include <algorithm>
#include <cstdint>

#include "core/base/assert.h"
#include "formats/log/log_packer.h"
#include "formats/log/unpacked_log.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(packed_log) {
  dance::UnpackedLog log = dance::UnpackedLog::over({data, size});
  unsigned sum = 0;
  while (const auto event = log.next()) {
    DANCE_ASSERT(!event->channel.empty() && event->channel.size() <= 255, event->channel.size());
    for (const char c : event->channel) sum += static_cast<unsigned char>(c);
    for (const std::uint8_t byte : event->data) sum += byte;
  }

  dance::LogReader reader = dance::LogReader::over({data, size});
  dance::LogPacker packer;
  dance::LogUnpacker unpacker;
  while (const auto event = reader.next()) {
    const auto again = unpacker.unpack(packer.pack(*event));
    DANCE_ASSERT(again.has_value());
    DANCE_ASSERT(again->number == event->number && again->time_us == event->time_us);
    DANCE_ASSERT(again->channel == event->channel);
    DANCE_ASSERT(
        std::equal(again->data.begin(), again->data.end(), event->data.begin(), event->data.end()));
  }
  // The sum touches every byte that was handed out; the sanitizer sees one that is not ours.
  return sum == 0xffffffffu ? 1 : 0;
}
