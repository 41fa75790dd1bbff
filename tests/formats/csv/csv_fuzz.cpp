// Any text as a table: reading ends, and every pose, skeleton, hand and beat that comes is valid.
#include <cstdint>

#include "core/base/assert.h"
#include "formats/csv/csv_reader.h"

namespace {

struct Checks : dance::RecordingSink {
  void on_skeleton(const dance::GuestId& guest, const dance::Skeleton& skeleton,
                   std::int64_t) override {
    DANCE_ASSERT(guest.is_set() && is_valid(skeleton));
  }
  void on_pose(const dance::GuestId& guest, const dance::Pose& pose, std::int64_t) override {
    DANCE_ASSERT(guest.is_set() && is_valid(pose), pose.sequence);
  }
  void on_hands(const dance::GuestId& guest, const dance::Hands& hands, std::int64_t) override {
    DANCE_ASSERT(guest.is_set() && is_valid(hands), hands.sequence);
  }
  void on_beat(const dance::Beat& beat, std::int64_t) override {
    DANCE_ASSERT(is_valid(beat), beat.beat);
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto reader = dance::CsvReader::over({reinterpret_cast<const char*>(data), size});
  if (!reader) return 0;
  Checks checks;
  static_cast<void>(reader->read_into(checks));
  return 0;
}
