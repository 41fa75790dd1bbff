// Any text as a table: reading ends, and every pose, skeleton, hand and beat that comes is valid.
#include <cstdint>

#include "formats/csv/csv_reader.h"
#include "tests/formats/recording/checked_sink.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(csv) {
  auto reader = dance::CsvReader::over({reinterpret_cast<const char*>(data), size});
  if (!reader) return 0;
  dance::CheckedSink checks;
  static_cast<void>(reader->read_into(checks));
  return 0;
}
