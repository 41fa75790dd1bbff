#include "formats/recorded/recorded_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "formats/clip/dancers_file.h"
#include "formats/csv/csv_reader.h"
#include "formats/mcap/dance_mcap_reader.h"
#include "formats/recorded/counted.h"
#include "formats/recording/clip_source.h"
#include "formats/recording/log_source.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

class RecordedLog : public RecordedFile {
 public:
  explicit RecordedLog(LogSource log) : log_(std::move(log)) {}
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

class RecordedMcap : public RecordedFile {
 public:
  explicit RecordedMcap(DanceMcapReader file) : file_(std::move(file)) {}
  Result<void> read_into(RecordingSink& sink) override { return file_.read_into(sink); }
  std::vector<std::string> notes() const override {
    std::vector<std::string> all;
    if (!file_.file().was_finished())
      all.emplace_back("its writer was stopped before the end; what it had written is all there");
    if (file_.was_sorted())
      all.emplace_back("its messages were not in the order of their times: sorted");
    if (const std::uint64_t bare = file_.counters().bare; bare > 0)
      all.push_back(
          fmt::format("{} poses are transforms alone: without music, sequence and clock", bare));
    return all;
  }
  std::string lost() const override {
    const McapReader::Counters& file = file_.file().counters();
    return listed({
        {file.damaged_chunks, "damaged chunks"},
        {file.damaged_bytes, "bytes that are no record"},
        {file.cut_records, "records that are cut off at the end"},
        {file.other_compression, "chunks compressed with neither zstd nor lz4"},
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

class RecordedTable : public RecordedFile {
 public:
  explicit RecordedTable(CsvReader table) : table_(std::move(table)) {}
  Result<void> read_into(RecordingSink& sink) override { return table_.read_into(sink); }
  std::vector<std::string> notes() const override {
    if (table_.note().empty()) return {};
    return {table_.note()};
  }
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

class RecordedClips : public RecordedFile {
 public:
  RecordedClips(std::vector<NamedClip> clips, std::vector<GuestId> names, std::int64_t start_us)
      : clips_(std::move(clips)), names_(std::move(names)), start_us_(start_us) {}

  Result<void> read_into(RecordingSink& sink) override {
    std::vector<GuestClip> guests;
    for (std::size_t i = 0; i < clips_.size(); ++i) guests.push_back({names_[i], &clips_[i].clip});
    play_clips_into(guests, start_us_, sink);
    return {};
  }
  std::vector<std::string> notes() const override {
    std::vector<std::string> all;
    for (const NamedClip& clip : clips_)
      all.insert(all.end(), clip.notes.begin(), clip.notes.end());
    return all;
  }
  std::string lost() const override {
    std::string all;
    for (const NamedClip& clip : clips_)
      if (!clip.lost.empty()) all += (all.empty() ? "" : ", ") + clip.lost;
    return all;
  }

 private:
  std::vector<NamedClip> clips_;
  std::vector<GuestId> names_;
  std::int64_t start_us_;
};

std::int64_t changed_us(const std::string& path) {
  std::error_code error;
  const auto time = fs::last_write_time(path, error);
  if (error) return 0;
  const auto wall = std::chrono::file_clock::to_sys(time).time_since_epoch();
  return std::max<std::int64_t>(
      1, std::chrono::duration_cast<std::chrono::microseconds>(wall).count());
}

// Each dancer has a name of its own: alice, alice-2. A dancer without one gets the file's.
std::vector<GuestId> names_of(const std::vector<NamedClip>& clips, const std::string& path) {
  std::vector<GuestId> names;
  for (const NamedClip& clip : clips) {
    const std::string name = guest_name_of(clip.name.empty() ? path : clip.name);
    GuestId id = GuestId::parse(name).value();
    for (int n = 2; std::find(names.begin(), names.end(), id) != names.end(); ++n) {
      const std::string end = "-" + std::to_string(n);
      id = GuestId::parse(name.substr(0, kMaxGuestIdLength - end.size()) + end).value();
    }
    names.push_back(id);
  }
  return names;
}

Result<std::unique_ptr<RecordedFile>> open_clips(const std::string& path,
                                                 const RecordedFileOptions& options) {
  DANCE_TRY(std::vector<NamedClip> clips, load_dancers(path, options.retarget));
  std::vector<GuestId> names = names_of(clips, path);
  if (options.guest.is_set() && names.size() == 1) names[0] = options.guest;
  return std::make_unique<RecordedClips>(std::move(clips), std::move(names), changed_us(path));
}

template <class Input, class File>
Result<std::unique_ptr<RecordedFile>> made(Result<File> file) {
  if (!file) return tl::make_unexpected(file.error());
  return std::make_unique<Input>(std::move(*file));
}

}  // namespace

Result<std::unique_ptr<RecordedFile>> RecordedFile::open(const std::string& path,
                                                         const RecordedFileOptions& options) {
  // Logs and MCAP files are read twice, and a pipe that nobody writes to would block the caller.
  std::error_code error;
  const auto status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_directory(status) && !fs::is_regular_file(status))
    return fail(path + ": is a pipe or a device; save the recording as a file, and name that");
  DANCE_TRY(const FileKind kind, input_kind(path));
  if (options.where && kind != FileKind::kLcm)
    return fail("--where chooses among the poses of an LCM log; leave it out for " + path);
  const bool is_clip = kind == FileKind::kBvh || kind == FileKind::kGlb;
  if ((options.retarget.metres_per_unit || options.retarget.up != UpAxis::kGuess) && !is_clip)
    return fail("--unit and --up are for BVH and glTF files; " + path +
                " is in metres with +Y up: leave them out");
  switch (kind) {
    case FileKind::kLcm:
      return made<RecordedLog>(LogSource::open(path, options.where));
    case FileKind::kMcap:
      return made<RecordedMcap>(DanceMcapReader::open(path));
    case FileKind::kCsv:
      return made<RecordedTable>(CsvReader::open(path));
    case FileKind::kBvh:
    case FileKind::kGlb:
      return open_clips(path, options);
  }
  return fail(path + ": of no known kind");
}

}  // namespace dance
