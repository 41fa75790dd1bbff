#include "transformers/rhythm/rhythm.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr std::size_t kRhythmPoses = 512;
constexpr Duration kRhythmRestart = Duration::s(1);
constexpr std::uint32_t kPosesPerProbe = 4;
constexpr std::uint32_t kUntaggedPoses = 30;
constexpr float kLeastConfidence = 0.25f;
// Before guesses of this dancer have been measured: in the first half minute of one whom no model
// has seen they are some 50 to 60 mm off at this distance.
constexpr Duration kUnknownReach = Duration::ms(180);
// Where the delay is the least that guesses allow, they need not be that good all the time.
constexpr double kSlack_beats = 0.1;
// Nobody is asked for further ahead of what they dance now than this; musics that drift apart may
// add the slack.
constexpr double kMostAhead_beats = 0.05;
// Of the lag of guesses so much is taken back: the further a guess reaches, the less sure it is.
constexpr double kLeadShare = 0.4;
constexpr Duration kSpare = Duration::ms(60);
// What is further off is jumped to; without music there is no hurry, so more of it is walked.
constexpr Duration kJumpInTime = Duration::ms(300);
constexpr Duration kJumpFree = Duration::s(1);

}  // namespace

Rhythm::Rhythm(const RhythmOptions& options) : options_(options), history_(kRhythmPoses) {}

void Rhythm::restart() {
  history_.clear();
  dance_.clear();
  play_out_.forget();
  offset_.reset();
  guesses_.clear();
  own_beat_.forget();
  untagged_ = 0;
  head_.reset();
  finish_.clear();
  has_shown_ = false;
}

void Rhythm::observe(const Pose& pose, MonoTime now) {
  if (!history_.empty()) {
    const Pose& newest = history_.newest();
    if (pose.clock_id != newest.clock_id ||
        pose.capture_time < newest.capture_time - kRhythmRestart) {
      ++counters_.restarts;
      restart();
    }
  }
  const MonoTime before = history_.empty() ? pose.capture_time : history_.newest().capture_time;
  if (!history_.push(pose)) {
    ++counters_.refused;
    return;
  }
  play_out_.add(pose.capture_time - before, now - pose.capture_time);
  take_tag(pose, now);
  finish_.observe(pose, now);
  has_news_ = true;
  guesses_.learn(history_);
  if (++observed_ % kPosesPerProbe == 0) probe(now);
}

void Rhythm::take_tag(const Pose& pose, MonoTime now) {
  double beats = pose.music_beats;
  // The comparison is false for no tag, too.
  if (std::abs(beats) <= kMostBeats) {
    untagged_ = 0;
  } else {
    // One pose without a tag is none; a dance without is one whose steps have to tell.
    if (++untagged_ < kUntaggedPoses || !music_.is_known(now)) return;
    if (untagged_ == kUntaggedPoses) own_beat_.forget();
    Pose untagged = pose;
    untagged.music_beats = kNoMusic;
    const auto position = own_beat_.observe(untagged, now, 60.0 * music_.beats_per_second());
    if (!position) {
      dance_.clear();
      return;
    }
    beats = *position;
  }
  if (dance_.add(pose.capture_time, beats)) offset_.reset();
}

void Rhythm::probe(MonoTime now) {
  if (!input_) return;
  const MonoTime moment = history_.newest().capture_time + guesses_.next_horizon();
  Pose guess;
  if (input_->sample_at(moment, now, guess)) guesses_.guess(guess, moment);
}

void Rhythm::hear(const Beat& beat, MonoTime /*now*/) {
  if (music_.hear(beat)) offset_.reset();
}

void Rhythm::set_body(const Skeleton& skeleton) {
  if (!is_valid(skeleton)) return;
  guesses_.set_body(skeleton);
  own_beat_.set_body(skeleton);
  finish_.set_body(skeleton);
}

MonoTime Rhythm::free_moment(MonoTime now) {
  return input_ ? input_->moment(now) : now - play_out_.needed();
}

void Rhythm::choose_offset(MonoTime now) {
  const double beats_per_second = dance_.beats_per_second();
  // Who asks for a beat of delay asks for the truth: it grows as soon as what is shown would have
  // to be guessed. A stall then finds as much behind the newest pose as can be.
  Duration reach;
  if (options_.beats < 0.0)
    reach = guesses_.is_known() ? guesses_.reach(options_.most_error_m) : kUnknownReach;
  BeatOffset::Wish wish;
  wish.slack_beats = options_.beats > 0.0 ? 0.0 : kSlack_beats;
  wish.beats = options_.beats;
  wish.count = options_.count;
  // Who asks for no delay at all gets guesses however far they have to reach.
  wish.least_beats = wish.easy_beats = -kMostAhead_beats;
  if (options_.beats != 0.0) {
    const Duration beyond = play_out_.needed() - reach;
    wish.least_beats = std::max(wish.least_beats, beyond.as_seconds() * beats_per_second);
    wish.easy_beats = std::max(wish.easy_beats, (beyond + kSpare).as_seconds() * beats_per_second);
  }
  offset_.update(wish, music_.position(now) - dance_.position(now), now);
}

MonoTime Rhythm::wanted_moment(MonoTime now, double& pace) {
  const MonoTime free = free_moment(now);
  pace = 1.0;
  in_time_ = options_.strength > 0.0 && music_.is_known(now) &&
             music_.confidence() >= kLeastConfidence && dance_.is_known(now);
  if (!in_time_) {
    offset_.reset();
    return free;
  }
  choose_offset(now);
  const MonoTime on_beat = dance_.time_of(music_.position(now) - offset_.value());
  pace = 1.0 + options_.strength * (music_.beats_per_second() / dance_.beats_per_second() - 1.0);
  return free + Duration::seconds(options_.strength * (on_beat - free).as_seconds());
}

bool Rhythm::pose_at(MonoTime moment, MonoTime now, Pose& out) {
  const Duration ahead = moment - history_.newest().capture_time;
  MonoTime asked = moment;
  // Only who is to be on the beat is worth the scatter.
  if (in_time_ && ahead > Duration())
    asked += Duration::seconds(kLeadShare * (guesses_.lead(ahead) - ahead).as_seconds());
  if (!input_ || !input_->sample_at(asked, now, out)) {
    const auto answer = history_.at(moment);
    if (!answer) return false;
    out = answer->pose;
  }
  return true;
}

MonoTime Rhythm::moment(MonoTime now) { return has_shown_ ? shown_moment_ : free_moment(now); }

bool Rhythm::sample_at(MonoTime moment, MonoTime now, Pose& out) {
  return !history_.empty() && pose_at(moment, now, out);
}

bool Rhythm::sample(MonoTime now, Pose& out) {
  if (history_.empty()) return false;
  if (options_.strength <= 0.0 && input_) return input_->sample(now, out);
  double pace = 1.0;
  const MonoTime wanted = wanted_moment(now, pace);
  Pose is;
  // What came since the last picture has changed what that picture should have been, where it was a
  // guess.
  if (has_shown_ && shown_is_guess_ && has_news_ && pose_at(shown_moment_, now, is))
    finish_.correct(now, shown_, is);
  has_news_ = false;
  MonoTime moment = head_.advance(now, wanted, pace);
  const Duration off = wanted - moment;
  const Duration most = in_time_ ? kJumpInTime : kJumpFree;
  if (has_shown_ && (off > most || off < -most)) {
    Pose was;
    if (pose_at(moment, now, was) && pose_at(wanted, now, is)) finish_.correct(now, was, is);
    head_.jump(wanted);
    moment = wanted;
  }
  if (!pose_at(moment, now, out)) return false;
  const bool is_guess = moment > history_.newest().capture_time;
  if (is_guess && !input_) ++counters_.starved;
  shown_ = out;
  // Between the newest two poses the curve is not known before the next one, either.
  shown_is_guess_ = is_guess || (history_.size() >= 2 && moment > history_.newest(1).capture_time);
  shown_moment_ = moment;
  has_shown_ = true;
  finish_.apply(now, out, is_guess);
  out.capture_time = moment;
  out.music_beats = dance_.is_known(moment) ? dance_.position(moment) : kNoMusic;
  return true;
}

}  // namespace dance
