// Any bytes as an MCAP file: reading ends, and every pose, skeleton, hand and beat is valid.
#include <cstdint>

#include "formats/mcap/dance_mcap_reader.h"
#include "tests/formats/recording/checked_sink.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(mcap) {
  auto reader = dance::DanceMcapReader::over({data, size});
  if (!reader) return 0;
  dance::CheckedSink checks;
  static_cast<void>(reader->read_into(checks));
  return 0;
}
