#include "transformers/flow.h"

#include <algorithm>

#include "core/motion/standing_odds.h"
#include "transformers/predict/dance_predictor.h"

namespace dance {

Flow::Flow(Slots slots)
    : timeline_(std::make_unique<DancerTimeline>(slots.poses)),
      clock_(std::move(slots.clock)),
      source_(std::make_unique<MotionSource>(*timeline_, std::move(slots.source))),
      finish_(slots.has_finish ? std::make_unique<Finish>(slots.half_life) : nullptr),
      filters_(std::move(slots.filters)),
      corrects_from_now_(slots.corrects_from_now),
      setting_(slots.setting),
      holds_hands_(slots.holds_hands) {
  const auto& on = setting_.on;
  if (!std::all_of(on.begin(), on.end(), [](bool is_on) { return is_on; })) set(setting_);
}

void Flow::set(const FlowSetting& setting) {
  if (is_pass_through() || !is_valid(setting)) return;
  FlowSetting wanted = setting;
  wanted.time = setting_.time;
  wanted.clock_id = setting_.clock_id;
  wanted.has = setting_.has;
  wanted.own = setting_.own;
  wanted.route = setting_.route;
  wanted.guest_gain = setting_.guest_gain;
  wanted.guest_periodic = setting_.guest_periodic;
  wanted.guest_dynamic = setting_.guest_dynamic;
  setting_ = wanted;
  clock_->set(wanted);
  // rhythm measures how far predictions are good.
  Duration reach = Duration::seconds(1e-3 * static_cast<double>(wanted.reach_ms));
  if (wanted.is_on(FlowWord::kRhythm)) reach = DancePredictor::kFurthest;
  if (wanted.has_word(FlowWord::kPredict) && !wanted.is_on(FlowWord::kPredict)) reach = Duration();
  source_->set(reach, wanted.is_on(FlowWord::kBridge));
  for (auto& filter : filters_) filter->set(wanted);
}

void Flow::observe(const Pose& pose, MonoTime now) {
  switch (timeline_->take(pose, now)) {
    case DancerTimeline::Taken::kRefused:
      return;
    case DancerTimeline::Taken::kRestarted:
      source_->restart();
      clock_->restart();
      if (finish_) finish_->clear();
      has_shown_ = false;
      break;
    case DancerTimeline::Taken::kTaken:
      break;
  }
  source_->observe();
  clock_->observe(*timeline_, *source_);
  if (finish_ && has_shown_) finish_->observe(pose, now);
  for (auto& filter : filters_) filter->observe(pose, now);
  has_news_ = true;
}

void Flow::hear(const Beat& beat) {
  if (timeline_ && timeline_->hear(beat)) clock_->on_music_jump();
}

void Flow::set_body(const Skeleton& skeleton) {
  if (!timeline_ || !timeline_->set_body(skeleton)) return;
  source_->set_body();
  clock_->set_body(skeleton);
  if (finish_) finish_->set_body(skeleton);
  for (auto& filter : filters_) filter->set_body(skeleton);
}

void Flow::set_style(const Style& style) {
  if (is_valid(style)) {
    setting_.guest_gain = style.gain;
    setting_.guest_periodic = style.periodic;
    setting_.guest_dynamic = style.dynamic;
  }
  for (auto& filter : filters_) filter->set_style(style);
}

void Flow::set_dancers(const PartnerTracks* dancers) {
  if (source_) source_->set_dancers(dancers);
}

void Flow::correct(const PlayoutClock::Choice& choice, MonoTime now, bool continues_from_here) {
  const PredictionLead lead = clock_->lead();
  Pose is;
  // What is known by now has changed what the picture before should have been.
  if (has_shown_ && (continues_from_here || has_news_ || source_->has_partner_news())) {
    const bool is_changed = is_shown_open_ || (continues_from_here && is_shown_repeated_);
    if (is_changed) source_->at(shown_moment_, is, lead);
    if (is_changed || (!corrects_from_now_ && !finish_->corrections().is_at_rest()))
      finish_->correct(corrects_from_now_ ? now : shown_at_, shown_, is_changed ? is : shown_);
  }
  if (has_shown_ && choice.instead_of.is_set()) {
    Pose was;
    source_->at(choice.instead_of, was, lead);
    source_->at(choice.moment, is, lead);
    finish_->correct(now, was, is);
  }
}

void Flow::foresee_feet(MonoTime moment) {
  // As the odds were learned.
  Pose before, there, after;
  source_->at_alone(moment - kStandingOddsStep, before);
  source_->at_alone(moment, there);
  source_->at_alone(moment + kStandingOddsStep, after);
  finish_->foresee(before, there, after, moment - timeline_->newest().capture_time);
}

bool Flow::sample(MonoTime now, Pose& out) {
  if (!timeline_ || timeline_->is_empty()) return false;
  const auto choice = clock_->choose(*timeline_, now, has_shown_ ? shown_capture_ : MonoTime());
  const PredictionLead lead = clock_->lead();
  source_->set_shown(choice.moment, now);
  const bool continues_from_here = source_->begin_continuation(choice.moment, now, lead);
  if (finish_) correct(choice, now, continues_from_here);
  const MotionSource::Kind kind = source_->at(choice.moment, out, lead);
  const bool is_repeated = kind == MotionSource::Kind::kRepeated;
  if (is_repeated || choice.stands ||
      (kind == MotionSource::Kind::kPredicted &&
       choice.moment > timeline_->newest().capture_time + source_->reach()))
    ++starved_;
  if (finish_) {
    is_shown_open_ = source_->is_open(choice.moment, kind);
    is_shown_repeated_ = is_repeated;
    if (is_shown_open_ || is_shown_repeated_) shown_ = out;
    // While corrections of what was predicted die away feet are held yet.
    const bool goes_over =
        kind == MotionSource::Kind::kDanced && !finish_->corrections().is_at_rest();
    if (source_->predicts() && (kind == MotionSource::Kind::kPredicted || goes_over))
      foresee_feet(choice.moment);
    finish_->apply(
        now, out, kind == MotionSource::Kind::kPredicted || kind == MotionSource::Kind::kContinued);
  }
  shown_capture_ = out.capture_time;
  clock_->tag(choice.moment, out);
  shown_moment_ = choice.moment;
  shown_at_ = now;
  has_shown_ = true;
  has_news_ = false;
  for (auto& filter : filters_) filter->apply(now, out);
  return true;
}

Duration Flow::longest_silence() const {
  return source_ && source_->conceals() ? Continuation::kLongest : Duration();
}

Playout Flow::playout(MonoTime now) const {
  Playout playout;
  if (!has_shown_) return playout;
  const auto ms = [](Duration d) { return static_cast<float>(d.as_ms()); };
  playout.delay_ms = ms(shown_at_ - shown_moment_);
  playout.ahead_ms = ms(shown_moment_ - timeline_->newest().capture_time);
  clock_->explain(*timeline_, now, playout);
  if (const PartnerGuide* guide = source_->partner()) {
    playout.partner = guide->partner().value_or(GuestId());
    if (playout.partner.is_set()) playout.partner_share = guide->holds().trust();
  }
  return playout;
}

Flow::Counters Flow::counters() const {
  Counters sum;
  sum.starved = starved_;
  if (timeline_) {
    sum.refused = timeline_->counters().refused;
    sum.restarts = timeline_->counters().restarts;
  }
  for (const auto& filter : filters_) {
    sum.refused += filter->refused();
    sum.restarts += filter->restarts();
  }
  return sum;
}

}  // namespace dance
