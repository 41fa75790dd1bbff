#include <vector>

#include "apps/convert/clip_output.h"
#include "core/program/whole_file.h"
#include "formats/gltf/glb.h"
#include "formats/recording/clips_together.h"

namespace dance {
namespace {

constexpr double kUsualFrames_hz = 60.0;

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
        clips_together(recording_, options_.hz > 0.0 ? options_.hz : kUsualFrames_hz);
    counters_ = together.counters;
    std::vector<NamedClip> clips;
    for (auto& [guest, clip] : together.clips) {
      frames_ += clip.frames.size();
      clips.push_back({std::string(guest.view()), std::move(clip), {}});
    }
    const auto bytes = write_glb(clips);
    if (!bytes) return fail(options_.name + ": " + bytes.error().what);
    return write_whole_file(options_.path, *bytes);
  }

  std::uint64_t frames() const override { return frames_; }
  std::string left_out() const override {
    std::string text;
    const auto add = [&text](std::uint64_t count, const char* what) {
      if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + what;
    };
    add(counters_.not_newer, " poses and hands that were not newer");
    add(counters_.beyond_bound, " frames beyond four hours of one dancer at 60 Hz");
    add(recording_.overflow().total(), " messages, as they were too many");
    return text;
  }
  std::string note() const override {
    return counters_.silences == 0
               ? ""
               : std::to_string(counters_.silences) + " silences, in which the dancer stands still";
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
