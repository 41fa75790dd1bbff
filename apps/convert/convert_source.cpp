#include "apps/convert/convert_source.h"

#include <fmt/format.h>

#include "apps/convert/clip_input.h"
#include "apps/convert/counted.h"
#include "formats/csv/csv_reader.h"
#include "formats/mcap/dance_mcap_reader.h"
#include "formats/recording/log_source.h"

namespace dance {
namespace {

class LogInput : public ConvertSource {
 public:
  explicit LogInput(LogSource log) : log_(std::move(log)) {}
  Result<void> read_into(RecordingSink& sink) override { return log_.read_into(sink); }
  Where where() const override { return log_.where(); }
  std::string lost() const override {
    return listed({
        {log_.skipped_bytes(), "bytes that are no event"},
        {log_.unpacking().damaged, "damaged packed events"},
        {log_.unpacking().orphaned, "packed events that go on from lost ones"},
        {log_.unpacking().newer, "events packed by a newer version of dance"},
        {log_.counters().undecodable, "messages that are not valid"},
        {log_.counters().beyond_guests, "messages of too many guests"},
    });
  }

 private:
  LogSource log_;
};

class McapInput : public ConvertSource {
 public:
  explicit McapInput(DanceMcapReader file) : file_(std::move(file)) {}
  Result<void> read_into(RecordingSink& sink) override { return file_.read_into(sink); }
  std::vector<std::string> notes() const override {
    std::vector<std::string> all;
    if (!file_.file().was_finished())
      all.emplace_back("its writer was stopped before the end; what it had written is all there");
    if (const std::uint64_t bare = file_.counters().bare; bare > 0)
      all.push_back(
          fmt::format("{} poses are transforms alone: without music, sequence and clock", bare));
    return all;
  }
  std::string lost() const override {
    const McapReader::Counters& file = file_.file().counters();
    return listed({
        {file.damaged_chunks, "damaged chunks"},
        {file.other_compression, "chunks that are not compressed with zstd"},
        {file.oversized, "records that are too large"},
        {file.malformed, "malformed records"},
        {file.without_channel, "messages without a channel"},
        {file.beyond_channels, "channels too many"},
        {file_.counters().unreadable, "messages that are not as their schema says"},
        {file_.counters().invalid, "messages that are not valid"},
        {file_.counters().without_transforms, "poses without their transforms"},
        {file_.counters().beyond_guests, "messages of too many guests"},
    });
  }

 private:
  DanceMcapReader file_;
};

class CsvInput : public ConvertSource {
 public:
  explicit CsvInput(CsvReader table) : table_(std::move(table)) {}
  Result<void> read_into(RecordingSink& sink) override { return table_.read_into(sink); }
  std::string lost() const override {
    return listed({
        {table_.counters().malformed, "rows with cells that are missing or no numbers"},
        {table_.counters().invalid, "rows that are no pose of a body"},
        {table_.counters().beyond_guests, "rows of too many guests"},
        {table_.too_long_lines(), "lines that are too long"},
    });
  }

 private:
  CsvReader table_;
};

template <class Input, class File>
Result<std::unique_ptr<ConvertSource>> made(Result<File> file) {
  if (!file) return tl::make_unexpected(file.error());
  return std::make_unique<Input>(std::move(*file));
}

}  // namespace

Result<std::unique_ptr<ConvertSource>> open_source(const std::string& path, const GuestId& guest,
                                                   std::optional<Where> where) {
  DANCE_TRY(const FileKind kind, input_kind(path));
  if (where && kind != FileKind::kLcm)
    return fail("--where chooses among the poses of an LCM log; leave it out for " + path);
  switch (kind) {
    case FileKind::kLcm:
      return made<LogInput>(LogSource::open(path, where));
    case FileKind::kMcap:
      return made<McapInput>(DanceMcapReader::open(path));
    case FileKind::kCsv:
      return made<CsvInput>(CsvReader::open(path));
    case FileKind::kBvh:
      return open_bvh_input(path, guest);
    case FileKind::kGlb:
      return open_glb_input(path, guest);
  }
  return fail(path + ": of no known kind");
}

}  // namespace dance
