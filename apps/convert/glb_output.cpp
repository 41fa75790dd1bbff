#include <vector>

#include "apps/convert/clip_output.h"
#include "consumers/output_file.h"
#include "formats/gltf/glb.h"
#include "formats/recorded/counted.h"
#include "formats/recording/clips_together.h"

namespace dance {
namespace {

constexpr double kUsualKeys_hz = 60.0;

// All dancers of a recording in one file: on one time line, so that a couple stays together.
class GlbOutput : public ConvertSink {
 public:
  explicit GlbOutput(const SinkOptions& options) : options_(options) {}

  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t time_us) override {
    recording_.on_skeleton(guest, skeleton, time_us);
  }
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t time_us) override {
    recording_.on_pose(guest, pose, time_us);
  }
  void on_hands(const GuestId& guest, const Hands& hands, std::int64_t time_us) override {
    recording_.on_hands(guest, hands, time_us);
  }
  void on_beat(const Beat&, std::int64_t) override {}

  Result<void> finish() override {
    ClipsTogether together =
        clips_together(recording_, options_.hz > 0.0 ? options_.hz : kUsualKeys_hz);
    counters_ = together.counters;
    std::vector<NamedClip> clips;
    for (auto& [guest, clip] : together.clips) {
      frames_ += clip.frames.size();
      clips.push_back({std::string(guest.view()), std::move(clip), {}});
    }
    const auto bytes = write_glb(clips);
    if (!bytes) return fail(options_.name + ": " + bytes.error().what);
    DANCE_TRY(const auto file, OutputFile::open(options_.path));
    file->write({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    return file->flush();
  }

  std::uint64_t frames() const override { return frames_; }
  std::string left_out() const override {
    return listed({{counters_.beyond_bound, "frames beyond four hours of one dancer at 60 Hz"},
                   {recording_.overflow().total(), "messages, as they were too many"}});
  }
  std::string note() const override {
    return listed({{counters_.silences, "silences, in which the dancer stands still"},
                   {counters_.not_newer, "poses and hands that were not newer"}});
  }

 private:
  static RecordingLimits limits() {
    RecordingLimits limits;
    limits.poses = kMostFramesTogether;
    limits.hands = kMostFramesTogether;
    limits.beats = 0;
    return limits;
  }

  SinkOptions options_;
  Recording recording_{limits()};
  ClipsTogether::Counters counters_;
  std::uint64_t frames_ = 0;
};

}  // namespace

std::unique_ptr<ConvertSink> make_glb_output(const SinkOptions& options) {
  return std::make_unique<GlbOutput>(options);
}

}  // namespace dance
