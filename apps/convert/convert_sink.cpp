#include "apps/convert/convert_sink.h"

#include "apps/convert/clip_output.h"
#include "consumers/text/csv_consumer.h"
#include "formats/mcap/dance_mcap_writer.h"
#include "formats/recording/log_sink.h"

namespace dance {
namespace {

class LogOutput : public ConvertSink {
 public:
  LogOutput(LogWriter writer, Where where) : log_(std::move(writer), where) {}
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t us) override {
    log_.on_skeleton(guest, skeleton, us);
  }
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t us) override {
    log_.on_pose(guest, pose, us);
    ++frames_;
  }
  void on_hands(const GuestId& guest, const Hands& hands, std::int64_t us) override {
    log_.on_hands(guest, hands, us);
  }
  void on_beat(const Beat& beat, std::int64_t us) override { log_.on_beat(beat, us); }
  Result<void> finish() override { return log_.finish(); }
  std::uint64_t frames() const override { return frames_; }

 private:
  LogSink log_;
  std::uint64_t frames_ = 0;
};

class McapOutput : public ConvertSink {
 public:
  explicit McapOutput(std::unique_ptr<OutputFile> file)
      : file_(std::move(file)), writer_([this](std::span<const std::uint8_t> bytes) {
          file_->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        }) {}
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t us) override {
    writer_.on_skeleton(guest, skeleton, us);
  }
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t us) override {
    writer_.on_pose(guest, pose, us);
  }
  void on_hands(const GuestId& guest, const Hands& hands, std::int64_t us) override {
    writer_.on_hands(guest, hands, us);
  }
  void on_beat(const Beat& beat, std::int64_t us) override { writer_.on_beat(beat, us); }
  Result<void> finish() override {
    writer_.finish();
    return file_->flush();
  }
  std::uint64_t frames() const override { return writer_.counters().poses; }
  std::string left_out() const override {
    const std::uint64_t count = writer_.counters().beyond_guests + writer_.counters().before_1970 +
                                writer_.file().left_out();
    if (count == 0) return "";
    return std::to_string(count) +
           " messages of too many guests, from before 1970, or beyond the file's bound";
  }

 private:
  std::unique_ptr<OutputFile> file_;
  DanceMcapWriter writer_;
};

class CsvOutput : public ConvertSink {
 public:
  explicit CsvOutput(std::unique_ptr<OutputFile> file) : table_(std::move(file), 0.0) {}
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t us) override {
    table_.on_skeleton(guest, skeleton, MonoTime::from_us(us));
  }
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t us) override {
    table_.on_pose(guest, pose, MonoTime::from_us(us));
    ++frames_;
  }
  void on_hands(const GuestId&, const Hands&, std::int64_t) override { has_more_ = true; }
  void on_beat(const Beat&, std::int64_t) override {}
  Result<void> finish() override { return table_.finish(); }
  std::uint64_t frames() const override { return frames_; }
  std::string note() const override {
    return has_more_ ? "a table has no fingers; all other formats have" : "";
  }

 private:
  CsvConsumer table_;
  std::uint64_t frames_ = 0;
  bool has_more_ = false;
};

}  // namespace

Result<std::unique_ptr<ConvertSink>> make_sink(FileKind kind, const SinkOptions& options) {
  switch (kind) {
    case FileKind::kBvh:
      return make_bvh_output(options);
    case FileKind::kGlb:
      return make_glb_output(options);
    case FileKind::kLcm: {
      DANCE_TRY(LogWriter writer, LogWriter::append_to(options.path));
      return std::make_unique<LogOutput>(std::move(writer), options.where);
    }
    case FileKind::kMcap: {
      DANCE_TRY(auto file, OutputFile::open(options.path));
      return std::make_unique<McapOutput>(std::move(file));
    }
    case FileKind::kCsv: {
      DANCE_TRY(auto file, OutputFile::open(options.path));
      return std::make_unique<CsvOutput>(std::move(file));
    }
  }
  return fail(options.name + ": of no known kind");
}

}  // namespace dance
