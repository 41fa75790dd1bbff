#include "formats/recording/clips_together.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/base/assert.h"
#include "core/pose/interpolate.h"

namespace dance {
namespace {

constexpr double kLongestGap_s = 2.0;
constexpr double kSecondsPerMicrosecond = 1e-6;

// From the times of a clock to those of the recording.
using ClockOffsets = std::map<std::uint64_t, std::int64_t>;

ClockOffsets offsets_of(const Recording& recording) {
  ClockOffsets offsets;
  const auto look_at = [&](const auto& list) {
    for (const auto& each : list) {
      const std::int64_t offset = each.time_us - each.value.capture_time.since_zero_us();
      const auto [known, is_new] = offsets.try_emplace(each.value.clock_id, offset);
      known->second = std::min(known->second, offset);
    }
  };
  for (const RecordedGuest& guest : recording.guests()) {
    look_at(guest.poses);
    look_at(guest.hands);
  }
  return offsets;
}

template <class T>
struct Track {
  std::vector<double> times_s;
  std::vector<const T*> values;
};

// Seconds from start_us; only what is newer than all before it.
template <class T>
Track<T> track_of(const std::vector<Recorded<T>>& list, const ClockOffsets& offsets,
                  std::int64_t start_us, std::uint64_t& not_newer) {
  Track<T> track;
  for (const Recorded<T>& each : list) {
    const std::int64_t time_us =
        each.value.capture_time.since_zero_us() + offsets.at(each.value.clock_id) - start_us;
    const double time_s = static_cast<double>(time_us) * kSecondsPerMicrosecond;
    if (!track.times_s.empty() && time_s <= track.times_s.back()) {
      ++not_newer;
      continue;
    }
    track.times_s.push_back(time_s);
    track.values.push_back(&each.value);
  }
  return track;
}

// The value at each of `count` frames.
template <class T>
std::vector<T> frames_of(const Track<T>& track, double hz, std::size_t count) {
  std::vector<T> frames;
  frames.reserve(count);
  std::size_t next = 0;
  for (std::size_t f = 0; f < count; ++f) {
    const double t = static_cast<double>(f) / hz;
    while (next < track.times_s.size() && track.times_s[next] <= t) ++next;
    if (next == 0 || next == track.times_s.size()) {
      frames.push_back(*track.values[next == 0 ? 0 : next - 1]);
      continue;
    }
    const double before_s = track.times_s[next - 1];
    const double step_s = track.times_s[next] - before_s;
    if (step_s > kLongestGap_s)
      frames.push_back(*track.values[next - 1]);
    else
      frames.push_back(interpolate(*track.values[next - 1], *track.values[next],
                                   static_cast<float>((t - before_s) / step_s)));
  }
  return frames;
}

struct Span {
  std::int64_t start_us = std::numeric_limits<std::int64_t>::max();
  std::int64_t end_us = std::numeric_limits<std::int64_t>::min();
};

Span span_of(const Recording& recording, const ClockOffsets& offsets) {
  Span span;
  for (const RecordedGuest& guest : recording.guests())
    for (const Recorded<Pose>& pose : guest.poses) {
      const std::int64_t time_us =
          pose.value.capture_time.since_zero_us() + offsets.at(pose.value.clock_id);
      span.start_us = std::min(span.start_us, time_us);
      span.end_us = std::max(span.end_us, time_us);
    }
  return span;
}

}  // namespace

ClipsTogether clips_together(const Recording& recording, double hz, std::size_t most_frames) {
  DANCE_ASSERT(hz > 0.0, hz);
  ClipsTogether together;
  const ClockOffsets offsets = offsets_of(recording);
  const Span span = span_of(recording, offsets);
  const auto dancers = static_cast<std::size_t>(
      std::count_if(recording.guests().begin(), recording.guests().end(),
                    [](const RecordedGuest& guest) { return !guest.poses.empty(); }));
  if (dancers == 0) return together;
  // A hundredth of a frame for rounding.
  const double last_frame =
      static_cast<double>(span.end_us - span.start_us) * kSecondsPerMicrosecond * hz + 0.01;
  const std::size_t wanted = static_cast<std::size_t>(std::min(last_frame, 1e12)) + 1;
  const std::size_t count = std::max<std::size_t>(1, std::min(wanted, most_frames / dancers));
  together.counters.beyond_bound = (wanted - count) * dancers;
  for (const RecordedGuest& guest : recording.guests()) {
    if (guest.poses.empty()) continue;
    const auto poses = track_of(guest.poses, offsets, span.start_us, together.counters.not_newer);
    for (std::size_t i = 1; i < poses.times_s.size(); ++i)
      together.counters.silences += poses.times_s[i] - poses.times_s[i - 1] > kLongestGap_s;
    MotionClip clip;
    clip.skeleton = guest.skeleton();
    clip.frame_hz = hz;
    clip.frames = frames_of(poses, hz, count);
    if (!guest.hands.empty())
      clip.hands = frames_of(
          track_of(guest.hands, offsets, span.start_us, together.counters.not_newer), hz, count);
    together.clips.push_back({guest.guest, std::move(clip)});
  }
  return together;
}

}  // namespace dance
