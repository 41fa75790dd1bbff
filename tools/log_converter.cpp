#include "tools/log_converter.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/log/unpacked_log.h"

namespace dance {

Result<LogConversion> convert_log(const std::string& from, const std::string& to, LogForm form) {
  DANCE_TRY(UnpackedLog log, UnpackedLog::open(from));
  DANCE_TRY(LogWriter writer, LogWriter::create(to));
  LogConversion conversion{from, to, form, 0, 0, 0, 0, {}, {}};
  LogPacker packer;
  while (const auto event = log.next()) {
    auto written = writer.append(form == LogForm::kPacked ? packer.pack(*event) : *event);
    if (!written) return tl::make_unexpected(written.error());
    ++conversion.events;
  }
  if (auto flushed = writer.flush(); !flushed) return tl::make_unexpected(flushed.error());
  std::error_code unknown;
  const auto size = std::filesystem::file_size(from, unknown);
  conversion.bytes_in = unknown ? 0 : size;
  conversion.bytes_out = writer.bytes();
  conversion.skipped_bytes = log.skipped_bytes();
  conversion.unpacking = log.unpacking();
  conversion.packing = packer.counters();
  return conversion;
}

std::string conversion_line(const LogConversion& conversion) {
  const bool packs = conversion.form == LogForm::kPacked;
  const std::uint64_t plain = packs ? conversion.packing.plain_bytes : conversion.bytes_out;
  const std::uint64_t packed = packs ? conversion.packing.bytes : conversion.bytes_in;
  const std::uint64_t messages = packs ? conversion.packing.packed : conversion.unpacking.unpacked;
  return fmt::format(
      "{}: {} events, {} of them packed; plain {} bytes, packed {} bytes, {:.1f} %\n",
      conversion.to, conversion.events, messages, plain, packed,
      plain == 0 ? 100.0 : 100.0 * static_cast<double>(packed) / static_cast<double>(plain));
}

Result<void> check_is_whole(const LogConversion& conversion) {
  const LogUnpacker::Counters& lost = conversion.unpacking;
  if (lost.lost() == 0 && conversion.skipped_bytes == 0) return {};
  if (conversion.events == 0 && lost.lost() == 0)
    return fail(conversion.from + ": is no LCM log; name one that was recorded");
  std::string what = fmt::format(
      "{}: damaged: {} bytes that are no event, {} damaged packed events, {} that go on from lost "
      "ones",
      conversion.from, conversion.skipped_bytes, lost.damaged, lost.orphaned);
  if (lost.newer > 0)
    what += fmt::format(", {} packed by a newer version of dance (update this one)", lost.newer);
  return fail(what + "; " + conversion.to + " holds all the rest");
}

}  // namespace dance
