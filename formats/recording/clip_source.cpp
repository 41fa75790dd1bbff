#include "formats/recording/clip_source.h"

#include <cmath>
#include <optional>
#include <vector>

namespace dance {
namespace {

constexpr std::uint64_t kClipClockId = 1;

std::int64_t frame_time_us(const MotionClip& clip, std::size_t frame) {
  return std::llround(static_cast<double>(frame) * 1e6 / clip.frame_hz);
}

void tell_frame(const GuestClip& of, std::size_t frame, std::int64_t time_us, RecordingSink& sink) {
  Pose pose = of.clip->frames[frame];
  pose.sequence = static_cast<std::uint32_t>(frame + 1);
  pose.clock_id = kClipClockId;
  pose.capture_time = MonoTime::from_us(time_us);
  pose.hops = {};
  if (frame == 0) sink.on_skeleton(of.guest, of.clip->skeleton, time_us);
  sink.on_pose(of.guest, pose, time_us);
  if (frame >= of.clip->hands.size()) return;
  Hands hands = of.clip->hands[frame];
  hands.sequence = pose.sequence;
  hands.clock_id = pose.clock_id;
  hands.capture_time = pose.capture_time;
  sink.on_hands(of.guest, hands, time_us);
}

}  // namespace

void play_clips_into(std::span<const GuestClip> clips, std::int64_t start_us, RecordingSink& sink) {
  std::vector<std::size_t> next(clips.size(), 0);
  for (;;) {
    std::optional<std::size_t> first;
    std::int64_t first_us = 0;
    for (std::size_t i = 0; i < clips.size(); ++i) {
      if (next[i] >= clips[i].clip->frames.size()) continue;
      const std::int64_t time_us = frame_time_us(*clips[i].clip, next[i]);
      if (first && time_us >= first_us) continue;
      first = i;
      first_us = time_us;
    }
    if (!first) return;
    tell_frame(clips[*first], next[*first]++, start_us + first_us, sink);
  }
}

}  // namespace dance
