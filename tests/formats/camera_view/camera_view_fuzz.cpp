// Any bytes, in pieces of any length: a fault, or values that may be used; never a crash.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "formats/camera_view/camera_view_reader.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(camera_view) {
  using dance::CameraViewReader;
  if (size == 0) return 0;
  static CameraViewReader fresh;
  CameraViewReader reader = fresh;
  std::span<const std::uint8_t> rest(data + 1, size - 1);
  const std::size_t piece = 1 + data[0] * 37UL;
  while (!rest.empty() && reader.fault() == CameraViewReader::Fault::kNone) {
    const auto room = reader.room();
    if (room.empty()) std::abort();
    const std::size_t count = std::min({piece, rest.size(), room.size()});
    std::copy_n(rest.begin(), count, room.begin());
    reader.add(count);
    rest = rest.subspan(count);
    if (reader.take_view() && (!is_valid(reader.facts()) || !is_valid(reader.picture())))
      std::abort();
    if (reader.take_status() && !is_valid(reader.status())) std::abort();
  }
  return 0;
}
