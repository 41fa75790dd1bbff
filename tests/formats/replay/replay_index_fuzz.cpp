// libFuzzer target: any bytes as a log's index, and once more with a checksum that fits; what is
// read is sound, and written again it is the same.
#include <cstddef>
#include <cstdint>

#include "core/base/assert.h"
#include "tests/formats/replay/some_index.h"
#include "tests/fuzz_target.h"

namespace dance {
namespace {

void check(std::span<const std::uint8_t> bytes) {
  const auto index = read_index(bytes);
  if (!index) {
    DANCE_ASSERT(!index.error().what.empty());
    return;
  }
  DANCE_ASSERT(index->begin <= index->end);
  for (const ReplayIndex::Gap& gap : index->gaps)
    DANCE_ASSERT(gap.guest < index->guests.size() && gap.begin <= gap.end);
  for (const ReplayIndex::Checkpoint& each : index->checkpoints)
    DANCE_ASSERT(each.from_bytes <= each.at_bytes && each.at_bytes <= index->log.bytes);
  for (const MonoTime moment : {index->begin, index->end, MonoTime()})
    DANCE_ASSERT(index->checkpoint_for(moment).at_bytes <= index->log.bytes);
  index->time_of_beat(1.5);
  const std::vector<std::uint8_t> again = write_index(*index);
  DANCE_ASSERT(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()));
}

}  // namespace
}  // namespace dance

DANCE_FUZZ_TARGET(replay_index) {
  dance::check({data, size});
  std::vector<std::uint8_t> sealed(data, data + size);
  dance::test::seal_index(sealed);
  dance::check(sealed);
  return 0;
}
