#include "research/rhythm/couple_film.h"

#include <algorithm>
#include <cmath>

#include "core/pose/interpolate.h"
#include "research/predict/predict_takes.h"
#include "testing/line/line_arrivals.h"
#include "transformers/partner/partner_tracks.h"

namespace dance {
namespace {

constexpr Duration kFilmLearnEvery = Duration::ms(250);
constexpr Duration kFilmBeatEvery = Duration::ms(100);

std::int64_t us_of(MonoTime t) { return (t - MonoTime()).count_ns() / 1000; }

Beat beat_at(const BeatGrid& music, MonoTime t) {
  const double s = (t - kRhythmEvalBegin).as_seconds();
  Beat beat;
  beat.time = t;
  beat.clock_id = 1;
  beat.beat = std::ceil(music.beat_at(s));
  beat.beat_time = kRhythmEvalBegin + Duration::seconds(music.time_of(beat.beat));
  beat.tempo_bpm = music.tempo_bpm(beat.beat);
  beat.beats_per_bar = music.beats_per_bar();
  beat.confidence = 1.0f;
  beat.playing = true;
  return beat;
}

// One way of showing the remote dancer.
struct FilmedFlow {
  FilmedWay way;
  Flow flow;
  GuestId remote, here;
  float aside_m = 0.0f;
};

}  // namespace

std::vector<FilmedWay> usual_ways(bool has_music) {
  std::vector<FilmedWay> ways{
      {"raw", {}}, {"predicted", {"predict partner=0"}}, {"partner", {"predict"}}};
  if (has_music) ways.push_back({"auto", {"predict", "bridge", "rhythm"}});
  ways.push_back({"danced", {}, true});
  return ways;
}

GuestId remote_of(const FilmedWay& way) { return *GuestId::parse(way.name); }
GuestId here_of(const FilmedWay& way) { return *GuestId::parse("here-" + way.name); }

BeatDance as_danced(const CodecTake& take, double hz) {
  BeatDance dance;
  dance.name = take.name;
  dance.skeleton = take.skeleton;
  const double last = static_cast<double>(take.poses.size() - 1);
  for (std::uint32_t i = 0; i / hz * take.hz < last; ++i) {
    const double frame = i / hz * take.hz;
    const auto whole = static_cast<std::size_t>(frame);
    dance.poses.push_back(interpolate(take.poses[whole], take.poses[whole + 1],
                                      static_cast<float>(frame - std::floor(frame))));
    Pose& pose = dance.poses.back();
    pose.sequence = i;
    pose.clock_id = 1;
    pose.capture_time = kRhythmEvalBegin + Duration::seconds(i / hz);
    pose.music_beats = kNoMusic;
  }
  return dance;
}

Result<void> film_couple(const BeatDance& here, const BeatDance& remote, const BeatGrid* music,
                         const std::vector<FilmedWay>& ways, const FilmOptions& options,
                         const FlowParts& parts, RecordingSink& sink) {
  const std::size_t frames = std::min(here.poses.size(), remote.poses.size());
  Random random(options.seed);
  const std::vector<Pose> seen_here = trembling(here.poses, options.noise_deg, random);
  std::vector<Pose> sent = trembling(remote.poses, options.noise_deg, random);
  if (!music)
    for (Pose& pose : sent) pose.music_beats = kNoMusic;
  LossySpec spec;
  spec.delay = options.delay;
  spec.tail = options.jitter;
  spec.loss = 0.01 * options.loss_percent;
  spec.seed = 0;
  LossyModel line({.spec = spec}, options.seed);
  const auto arrivals =
      arrivals_over(line, frames, [&](std::size_t i) { return sent[i].capture_time; });

  PartnerTracks dancers;
  const GuestId partner = *GuestId::parse("here");
  std::vector<FilmedFlow> shown;
  for (const FilmedWay& way : ways) {
    DANCE_TRY(Flow flow, Flow::make(way.through, parts));
    shown.push_back({way, std::move(flow), remote_of(way), here_of(way),
                     kBetween_m * static_cast<float>(shown.size()) -
                         0.5f * kBetween_m * static_cast<float>(ways.size() - 1)});
    shown.back().flow.set_body(remote.skeleton);
    shown.back().flow.set_dancers(&dancers);
    const std::int64_t begin_us = us_of(kRhythmEvalBegin);
    sink.on_skeleton(shown.back().remote, remote.skeleton, begin_us);
    sink.on_skeleton(shown.back().here, here.skeleton, begin_us);
  }
  MonoTime next_beat = kRhythmEvalBegin, next_learn = kRhythmEvalBegin + kFilmLearnEvery;
  std::size_t arrived = 0;
  const Pose* newest = nullptr;
  for (std::size_t i = 0; i < frames; ++i) {
    const MonoTime now = here.poses[i].capture_time;
    const std::int64_t now_us = us_of(now);
    for (; music && next_beat <= now; next_beat += kFilmBeatEvery) {
      const Beat beat = beat_at(*music, next_beat);
      for (FilmedFlow& s : shown) s.flow.hear(beat);
      sink.on_beat(beat, now_us);
    }
    dancers.take(partner, seen_here[i], &here.skeleton);
    for (; arrived < arrivals.size() && arrivals[arrived].at <= now; ++arrived) {
      const Pose& pose = sent[arrivals[arrived].index];
      if (!newest || pose.capture_time > newest->capture_time) newest = &pose;
      for (FilmedFlow& s : shown)
        if (!s.flow.is_pass_through()) s.flow.observe(pose, arrivals[arrived].at);
    }
    if (now >= next_learn) {
      for (FilmedFlow& s : shown)
        if (const auto learner = s.flow.learner()) learner->learn();
      next_learn += kFilmLearnEvery;
    }
    for (FilmedFlow& s : shown) {
      Pose pose;
      if (s.way.is_truth)
        pose = remote.poses[i];
      else if (!s.flow.is_pass_through()) {
        if (!s.flow.sample(now, pose)) continue;
      } else if (newest) {
        pose = *newest;
      } else {
        continue;
      }
      const auto put = [&](const GuestId& guest, Pose staged) {
        staged.p_WH_m.x() += s.aside_m;
        staged.sequence = static_cast<std::uint32_t>(i);
        sink.on_pose(guest, staged, now_us);
      };
      put(s.here, here.poses[i]);
      put(s.remote, pose);
    }
  }
  return {};
}

}  // namespace dance
