#include "formats/log/unpacked_log.h"

namespace dance {

Result<UnpackedLog> UnpackedLog::open(const std::string& path) {
  DANCE_TRY(LogReader reader, LogReader::open(path));
  return UnpackedLog(std::move(reader));
}

UnpackedLog UnpackedLog::over(std::span<const std::uint8_t> bytes) {
  return UnpackedLog(LogReader::over(bytes));
}

std::optional<LogEvent> UnpackedLog::next() {
  while (const auto event = reader_.next())
    if (auto plain = unpacker_.unpack(*event)) return plain;
  return std::nullopt;
}

void UnpackedLog::rewind() {
  reader_.rewind();
  unpacker_.restart();
}

}  // namespace dance
