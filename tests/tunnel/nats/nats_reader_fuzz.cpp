// What a NATS server, or who stands in its place, may send: whatever the cuts, what is given back
// lies within what came, and the reader never stops taking.
#include <algorithm>
#include <cstdlib>

#include "tests/fuzz_target.h"
#include "tunnel/nats/messages/nats_reader.h"

DANCE_FUZZ_TARGET(nats_reader) {
  if (size < 1) return 0;
  const std::size_t step = data[0] + std::size_t{1};
  dance::NatsReader reader;
  for (std::size_t at = 1; at < size && !reader.is_broken(); at += step) {
    const std::size_t count = std::min(step, size - at);
    const auto room = reader.room();
    if (room.size() < count) std::abort();
    std::copy(data + at, data + at + count, room.begin());
    reader.add(count);
    std::size_t items = 0;
    while (const auto item = reader.next()) {
      ++items;
      if (item->payload.size() > dance::NatsReader::kMaxMessage) std::abort();
      unsigned sum = 0;
      for (const char c : item->text) sum += static_cast<unsigned char>(c);
      for (const std::uint8_t byte : item->payload) sum += byte;
      if (sum == 0xffffffffu) std::abort();
    }
    if (reader.is_broken()) break;
    reader.rewind();
    std::size_t again = 0;
    while (reader.next()) ++again;
    if (again != items) std::abort();
  }
  return 0;
}
