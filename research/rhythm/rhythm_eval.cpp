#include "research/rhythm/rhythm_eval.h"

#include <algorithm>
#include <cmath>

#include "research/predict/predict_takes.h"
#include "testing/line/line_arrivals.h"
#include "testing/motion/beat_phase.h"
#include "transformers/partner/partner_tracks.h"

namespace dance {
namespace {

constexpr Duration kBeatEvery = Duration::ms(100);
constexpr Duration kLearnEvery = Duration::s(1);
// Nobody sees a foot slide more slowly: synthetic dancers' do not at all.
constexpr double kStill_m_s = 0.02;
// The last bar is left out: the lock-in needs half a bar on both sides.
constexpr Duration kCoolDown = Duration::s(1);

MonoTime at_second(double s) { return kRhythmEvalBegin + Duration::seconds(s); }
double second_of(MonoTime t) { return (t - kRhythmEvalBegin).as_seconds(); }

// What a house hears: the song, a little faster or slower.
struct HeardMusic {
  const BeatGrid& grid;
  double speed = 1.0;

  double beats_at(MonoTime t) const { return grid.beat_at(second_of(t) * speed); }
  Beat beat_at(MonoTime t) const {
    Beat beat;
    beat.time = t;
    beat.clock_id = 1;
    beat.beat = std::ceil(beats_at(t));
    beat.beat_time = at_second(grid.time_of(beat.beat) / speed);
    beat.tempo_bpm = grid.tempo_bpm(beat.beat) * speed;
    beat.beats_per_bar = grid.beats_per_bar();
    beat.confidence = 1.0f;
    beat.playing = true;
    return beat;
  }
};

struct Shown {
  std::vector<Pose> poses;
  std::vector<std::size_t> frames;  // of the truth, at the same moment
};

// The partner dances to the music that is heard here.
Pose partner_at(const BeatDance& partner, MonoTime now, double speed, double hz) {
  const auto last = static_cast<double>(partner.poses.size() - 1);
  const double frame = std::round(second_of(now) * speed * hz);
  Pose pose = partner.poses[static_cast<std::size_t>(std::clamp(frame, 0.0, last))];
  pose.capture_time = now;
  return pose;
}

// Plays the arrivals through the flow, one picture for each moment of the dance.
Shown play(const BeatDance& dance, const std::vector<LineArrival>& arrivals, Flow& flow,
           const HeardMusic& music, double hz) {
  Shown shown;
  const auto learner = flow.learner();
  flow.set_body(dance.skeleton);
  PartnerTracks dancers;
  const GuestId here = *GuestId::parse("here");
  if (dance.partner) {
    flow.set_dancers(&dancers);
  }
  MonoTime next_beat = kRhythmEvalBegin, next_learn = kRhythmEvalBegin + kLearnEvery;
  const Pose* newest = nullptr;
  std::size_t arrived = 0;
  for (std::size_t i = 0; i < dance.poses.size(); ++i) {
    const MonoTime now = dance.poses[i].capture_time;
    for (; next_beat <= now; next_beat += kBeatEvery) flow.hear(music.beat_at(next_beat));
    if (dance.partner)
      dancers.take(here, partner_at(*dance.partner, now, music.speed, hz),
                   &dance.partner->skeleton);
    for (; arrived < arrivals.size() && arrivals[arrived].at <= now; ++arrived) {
      const Pose& pose = dance.poses[arrivals[arrived].index];
      if (!newest || pose.capture_time > newest->capture_time) newest = &pose;
      if (!flow.is_pass_through()) flow.observe(pose, arrivals[arrived].at);
    }
    if (now >= next_learn) {
      if (learner) learner->learn();
      next_learn += kLearnEvery;
    }
    Pose pose;
    if (flow.is_pass_through()) {
      if (!newest) continue;
      pose = *newest;
    } else if (!flow.sample(now, pose)) {
      continue;
    }
    shown.poses.push_back(pose);
    shown.frames.push_back(i);
  }
  return shown;
}

struct Rates {
  double least = 10.0, most = 0.0;
  std::vector<std::size_t> jumps;  // frames that do not go on from the one before
};

// How fast the moment that is shown goes on.
Rates rates_of(const std::vector<Pose>& shown, double hz, std::size_t from, std::size_t to) {
  constexpr double kJumpRate = 3.0;
  Rates rates;
  for (std::size_t i = from + 1; i < to; ++i) {
    const double rate = (shown[i].capture_time - shown[i - 1].capture_time).as_seconds() * hz;
    if (rate > kJumpRate || rate < -0.01) {
      rates.jumps.push_back(i);
      continue;
    }
    rates.least = std::min(rates.least, rate);
    rates.most = std::max(rates.most, rate);
  }
  return rates;
}

// Without the first and the last frame of each stance: between two frames of the dance a foot may
// just have lifted.
Stance well_within(const Stance& stance) {
  Stance inner = stance;
  for (std::size_t i = 0; i < stance.stands.size(); ++i)
    for (std::size_t side = 0; side < 2; ++side)
      inner.stands[i][side] = i > 0 && i + 1 < stance.stands.size() && stance.stands[i - 1][side] &&
                              stance.stands[i][side] && stance.stands[i + 1][side];
  return inner;
}

// To which beat the moment was danced; before the first and behind the last pose the pace goes on.
double danced_beats(const BeatDance& dance, MonoTime moment, double hz) {
  const double frame = second_of(moment) * hz;
  const double last = static_cast<double>(dance.beats.size() - 2);
  const double below = std::clamp(std::floor(frame), 0.0, last);
  const auto i = static_cast<std::size_t>(below);
  return dance.beats[i] + (frame - below) * (dance.beats[i + 1] - dance.beats[i]);
}

RhythmScore score_of(const BeatDance& dance, const Shown& shown, const HeardMusic& listener,
                     const RhythmEvalOptions& options) {
  RhythmScore score;
  const auto warm_up = static_cast<std::size_t>(options.warm_up.as_seconds() * options.hz);
  const auto cool_down = static_cast<std::size_t>(kCoolDown.as_seconds() * options.hz);
  if (shown.poses.size() < warm_up + cool_down + 60) return score;
  const std::size_t from = warm_up, to = shown.poses.size() - cool_down;
  std::vector<Pose> truth;  // beside what is shown
  for (const std::size_t frame : shown.frames) truth.push_back(dance.poses[frame]);
  const JointTrack track(dance.skeleton, shown.poses, options.hz);
  const JointTrack at_that_moment(dance.skeleton, truth, options.hz);
  const JointTrack all(dance.skeleton, dance.poses, options.hz);

  DanceOnBeats on_beats{&track, {}};
  std::vector<double> offsets;
  double delay_s = 0.0;
  for (std::size_t i = 0; i < shown.poses.size(); ++i) {
    const MonoTime now = dance.poses[shown.frames[i]].capture_time;
    const MonoTime moment = shown.poses[i].capture_time;
    const double heard = listener.beats_at(now);
    on_beats.beats.push_back(heard);
    offsets.push_back(std::round(heard - danced_beats(dance, moment, options.hz)));
    if (i >= from && i < to)
      delay_s += (now - moment).as_seconds() / static_cast<double>(to - from);
  }
  const Rates rates = rates_of(shown.poses, options.hz, from, to);
  for (const std::size_t jump : rates.jumps) on_beats.jumps.push_back(on_beats.beats[jump]);
  const BeatPhase phase = beat_phase(on_beats, {&all, dance.beats}, offsets, from, to);
  const double beat_ms = 60e3 / (listener.grid.tempo_bpm(on_beats.beats[from]) * listener.speed);
  score.phase_mean_ms = phase.mean_beats * beat_ms;
  score.phase_sd_ms = phase.sd_beats * beat_ms;
  score.phase_told = phase.told;
  score.content_delay_ms = delay_s * 1e3;
  score.mpjpe_mm = body_error_m(track, at_that_moment, from, to) * 1e3;
  // Smoothness and feet from the warm-up on, of both.
  const auto part = [&](const std::vector<Pose>& poses) {
    return JointTrack(dance.skeleton, std::span(poses).subspan(from, to - from), options.hz);
  };
  const JointTrack ours = part(shown.poses), theirs = part(truth);
  score.jerk_ratio =
      jerk_m_s3(ours, Places::kWorld) / std::max(1e-9, jerk_m_s3(theirs, Places::kWorld));
  // Feet that stood in the moment that is shown should stand in the picture.
  const Stance stance = well_within(stance_of(all));
  Stance as_danced, as_shown;
  for (std::size_t i = from; i < to; ++i) {
    const double frame = second_of(shown.poses[i].capture_time) * options.hz;
    const double last = static_cast<double>(stance.stands.size() - 1);
    as_shown.stands.push_back(
        stance.stands[static_cast<std::size_t>(std::clamp(frame, 0.0, last))]);
    as_danced.stands.push_back(stance.stands[shown.frames[i]]);
  }
  score.foot_slide_ratio =
      slide_m_s(ours, as_shown) / std::max(kStill_m_s, slide_m_s(theirs, as_danced));
  score.bone_length_error_mm = track.bone_length_error_m * 1e3;
  score.least_rate = rates.least;
  score.most_rate = rates.most;
  score.jumps = static_cast<double>(rates.jumps.size());
  for (const std::size_t jump : rates.jumps) {
    const auto joints_at = [&](MonoTime moment) {
      const double frame = std::round(second_of(moment) * options.hz);
      return all.world[static_cast<std::size_t>(
          std::clamp(frame, 0.0, static_cast<double>(all.size() - 1)))];
    };
    const auto before = joints_at(shown.poses[jump - 1].capture_time);
    const auto after = joints_at(shown.poses[jump].capture_time);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      score.jump_mm += static_cast<double>((after[b] - before[b]).norm()) * 1e3 /
                       static_cast<double>(kBoneCount * rates.jumps.size());
  }
  return score;
}

RhythmScore mean_of(const std::vector<RhythmScore>& scores) {
  RhythmScore mean;
  mean.least_rate = 10.0;
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, scores.size()));
  double phase_square = 0.0;
  for (const RhythmScore& s : scores) {
    mean.phase_mean_ms += share * s.phase_mean_ms;
    phase_square += share * s.phase_sd_ms * s.phase_sd_ms;
    mean.phase_told += share * s.phase_told;
    mean.content_delay_ms += share * s.content_delay_ms;
    mean.mpjpe_mm += share * s.mpjpe_mm;
    mean.jerk_ratio += share * s.jerk_ratio;
    mean.foot_slide_ratio += share * s.foot_slide_ratio;
    mean.bone_length_error_mm = std::max(mean.bone_length_error_mm, s.bone_length_error_mm);
    mean.least_rate = std::min(mean.least_rate, s.least_rate);
    mean.most_rate = std::max(mean.most_rate, s.most_rate);
    mean.jumps += share * s.jumps;
    mean.jump_mm += share * s.jumps * s.jump_mm;
  }
  mean.phase_sd_ms = std::sqrt(phase_square);
  if (mean.jumps > 0.0) mean.jump_mm /= mean.jumps;
  return mean;
}

}  // namespace

Result<RhythmRun> evaluate_rhythm(const std::vector<BeatDance>& dances, const BeatGrid& music,
                                  const NamedFlow& flow, const RhythmEvalOptions& options) {
  RhythmRun run;
  run.name = flow.name;
  const HeardMusic listener{music, 1.0 + options.tempo_offset_percent / 100.0};
  Random random(options.seed);
  for (const BeatDance& dance : dances) {
    LossySpec spec;
    spec.delay = options.delay;
    spec.tail = options.jitter;
    spec.loss = 0.01 * options.loss_percent;
    spec.seed = 0;
    LossyModel line({.spec = spec}, options.seed);
    auto arrivals = arrivals_over(
        line, dance.poses.size(), [&](std::size_t i) { return dance.poses[i].capture_time; },
        options.every);
    const MonoTime middle = at_second(0.5 * static_cast<double>(dance.poses.size()) / options.hz);
    stall(arrivals, middle, options.stall);
    // What is sent trembles; what is shown is judged against the dance without.
    BeatDance sent = dance;
    if (options.noise_deg > 0.0) sent.poses = trembling(dance.poses, options.noise_deg, random);
    if (options.untagged)
      for (Pose& pose : sent.poses) pose.music_beats = kNoMusic;
    DANCE_TRY(Flow made, Flow::make(flow.through, flow.parts));
    const Shown shown = play(sent, arrivals, made, listener, options.hz);
    run.dances.push_back(score_of(dance, shown, listener, options));
    const RhythmScore& score = run.dances.back();
    run.phase_mean_ms_worst = std::max(run.phase_mean_ms_worst, std::abs(score.phase_mean_ms));
    run.phase_sd_ms_worst = std::max(run.phase_sd_ms_worst, score.phase_sd_ms);
  }
  run.mean = mean_of(run.dances);
  return run;
}

}  // namespace dance
