#include "apps/record/log_converter.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/program/part_file.h"
#include "formats/log/unpacked_log.h"

namespace dance {
namespace {

std::string reason_for_no_events(const LogConversion& conversion) {
  const LogUnpacker::Counters& lost = conversion.unpacking;
  if (lost.newer > 0) return "was packed by a newer version of dance: update this one";
  if (lost.lost() > 0) return "all of its packed events are damaged";
  if (conversion.skipped_bytes > 0) return "is no LCM log; name one that was recorded";
  return "is empty; name a log that holds something";
}

}  // namespace

Result<LogConversion> convert_log(const std::string& from, const std::string& to, LogForm form) {
  DANCE_TRY(UnpackedLog log, UnpackedLog::open(from));
  DANCE_TRY(const auto part, PartFile::create(to));
  DANCE_TRY(LogWriter writer, LogWriter::append_to(part->path()));
  LogConversion conversion{from, to, form, 0, 0, 0, 0, {}, {}};
  LogPacker packer;
  while (const auto event = log.next()) {
    auto written = writer.append(form == LogForm::kPacked ? packer.pack(*event) : *event);
    if (!written) return tl::make_unexpected(written.error());
    ++conversion.events;
  }
  if (auto ended = log.ended(); !ended) return tl::make_unexpected(ended.error());
  conversion.skipped_bytes = log.skipped_bytes();
  conversion.unpacking = log.unpacking();
  if (conversion.events == 0) return fail(from + ": " + reason_for_no_events(conversion));
  if (auto flushed = writer.flush(); !flushed) return tl::make_unexpected(flushed.error());
  if (auto kept = part->keep(); !kept) return tl::make_unexpected(kept.error());
  std::error_code unknown;
  const auto size = std::filesystem::file_size(from, unknown);
  conversion.bytes_in = unknown ? 0 : size;
  conversion.bytes_out = writer.bytes();
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
  std::string what = fmt::format(
      "{}: damaged: {} bytes that are no event, {} damaged packed events, {} that go on from lost "
      "ones",
      conversion.from, conversion.skipped_bytes, lost.damaged, lost.orphaned);
  if (lost.newer > 0)
    what += fmt::format(", {} packed by a newer version of dance (update this one)", lost.newer);
  return fail(what + "; " + conversion.to + " holds all the rest");
}

std::string packed_before(const LogConversion& conversion) {
  if (conversion.form != LogForm::kPacked || conversion.unpacking.unpacked == 0) return "";
  return fmt::format(
      "{}: {} of its events were packed already; `dance unpack` will give their messages back, not "
      "this file byte for byte",
      conversion.from, conversion.unpacking.unpacked);
}

}  // namespace dance
