#include "transformers/partner/partner_guide.h"

#include <algorithm>

namespace dance {
namespace {

constexpr Duration kPalmProbeEvery = Duration::ms(33);
// Where what is shown jumps by more, what waits was asked of another time of the partner's.
constexpr Duration kSameLag = Duration::ms(50);
constexpr Duration kLeastPalmsAhead = Duration::ms(50), kMostPalmsAhead = Duration::ms(500);
constexpr double kPartnerStrengthPerSecond = 2.0;
constexpr double kPartnerLetGo_s = 0.3;
constexpr Duration kLongestPartnerStep = Duration::ms(250);
// Poses further apart say nothing certain of a moment between them.
constexpr Duration kPalmsCloseTogether = Duration::ms(100);

}  // namespace

PartnerGuide::PartnerGuide() : skeleton_(average_skeleton()) {}

void PartnerGuide::set_dancers(const PartnerTracks* dancers) {
  dancers_ = dancers;
  restart();
}

void PartnerGuide::set_body(const Skeleton& skeleton) {
  if (is_valid(skeleton)) skeleton_ = skeleton;
}

void PartnerGuide::restart() {
  finder_.clear();
  partner_ = std::nullopt;
  holds_.clear();
  strength_ = 0.0f;
  has_newest_ = false;
  was_met_ = has_news_ = false;
  probe_count_ = 0;
  probed_at_ = learnt_at_ = MonoTime();
}

PartnerGuide::Shape PartnerGuide::shape_of(const Pose& pose) const {
  BodyFrames frames;
  forward_kinematics(skeleton_, pose, frames);
  return {pose.capture_time,
          {{palm_of(skeleton_, frames, 0), palm_of(skeleton_, frames, 1)},
           frames.p_WB_m[0],
           facing_along(frames.R_WB[0] * Eigen::Vector3f::UnitZ()),
           {frames.R_WB[index_of(kLeftArm.lower)], frames.R_WB[index_of(kRightArm.lower)]}}};
}

const PartnerTrack* PartnerGuide::track() const {
  if (!dancers_ || !partner_ || dancers_->generation(*partner_) != partner_generation_)
    return nullptr;
  const PartnerTrack& track = (*dancers_)[*partner_];
  return track.is_empty() || track.clock_id() != clock_id_ ? nullptr : &track;
}

std::optional<GuestId> PartnerGuide::partner() const {
  if (!track() || strength_ <= 0.0f) return std::nullopt;
  return dancers_->guest(*partner_);
}

void PartnerGuide::follow_strength(bool is_couple, double step_s) {
  const double step = kPartnerStrengthPerSecond * std::clamp(step_s, 0.0, 1.0);
  strength_ = static_cast<float>(
      std::clamp(static_cast<double>(strength_) + (is_couple ? step : -step), 0.0, 1.0));
}

void PartnerGuide::set_shown(MonoTime moment, MonoTime now) {
  const Duration lag = now - moment;
  if (lag - lag_ > kSameLag || lag_ - lag > kSameLag) probe_count_ = 0;
  lag_ = lag;
  const Duration ahead = moment - newest_.time;
  if (has_newest_ && ahead > Duration())
    ahead_ = std::clamp(ahead_ + (ahead - ahead_) / 16, kLeastPalmsAhead, kMostPalmsAhead);
  const PartnerTrack* beside = track();
  const MonoTime seen = beside ? beside->newest().time : MonoTime();
  has_news_ = seen != partner_seen_;
  partner_seen_ = seen;
}

// How the two stood to each other at the newest pose; nothing while that is not known of both.
std::optional<Meeting> PartnerGuide::meeting() const {
  const PartnerTrack* beside = track();
  const auto partner = beside && has_newest_ ? beside->at(newest_.time + lag_) : std::nullopt;
  if (!partner) return std::nullopt;
  Meeting met = Meeting::of(newest_.figure, *partner);
  holds_.describe(met);
  return met;
}

void PartnerGuide::observe(const Pose& pose, MonoTime now, const Extrapolator& extrapolator) {
  if (!dancers_ || dancers_->size() == 0) return;
  clock_id_ = pose.clock_id;
  const Shape shape = shape_of(pose);
  const Duration step = has_newest_ ? shape.time - newest_.time : Duration();
  if (step > kLongestPartnerStep) {
    probe_count_ = 0;
    has_newest_ = false;
  }
  const double step_s = std::min(step, kLongestPartnerStep).as_seconds();
  const CoupleFinder::Stance stance{shape.figure.palms,    shape.figure.p_WHips_m,
                                    shape.figure.facing_W, clock_id_,
                                    shape.time + lag_,     now};
  const auto found = finder_.update(*dancers_, stance, step_s);
  const bool is_same =
      found && found == partner_ && partner_generation_ == dancers_->generation(*partner_);
  if (has_newest_) learn(shape);
  newest_ = shape;
  has_newest_ = true;
  // Where hands have nothing to say, what they say next is come to gradually.
  const auto met = is_same ? meeting() : std::nullopt;
  const bool is_met = met.has_value();
  if (is_met) holds_.follow(*met, step_s);
  if (is_met && !was_met_) strength_ = 0.0f;
  was_met_ = is_met;
  follow_strength(is_met, step_s);
  if (!is_same && strength_ <= 0.0f) {
    partner_ = found;
    partner_generation_ = found ? dancers_->generation(*found) : 0;
    holds_.clear();
    probe_count_ = 0;
  }
  if (!probed_at_.is_set() || shape.time - probed_at_ >= kPalmProbeEvery) {
    probed_at_ = shape.time;
    probe(extrapolator);
  }
}

void PartnerGuide::learn(const Shape& now) {
  const PartnerTrack* beside = track();
  while (probe_count_ > 0 && probes_[first_probe_].moment <= now.time) {
    const Probe& probe = probes_[first_probe_];
    first_probe_ = (first_probe_ + 1) % kProbes;
    --probe_count_;
    const Duration span = now.time - newest_.time;
    if (!beside || span > kPalmsCloseTogether || probe.moment < newest_.time) continue;
    const auto partner = beside->at(probe.moment + lag_);
    if (!partner) continue;
    const auto t = static_cast<float>((probe.moment - newest_.time).as_seconds() /
                                      std::max(span.as_seconds(), 1e-6));
    Palms came;
    for (std::size_t side = 0; side < 2; ++side)
      came[side] =
          newest_.figure.palms[side] + t * (now.figure.palms[side] - newest_.figure.palms[side]);
    const double step_s =
        learnt_at_.is_set() ? std::clamp((probe.moment - learnt_at_).as_seconds(), 0.0, 1.0) : 0.0;
    learnt_at_ = probe.moment;
    holds_.learn(probe.met, probe.predicted, probe.ahead_s, came, *partner, step_s);
  }
}

void PartnerGuide::probe(const Extrapolator& extrapolator) {
  const auto met = meeting();
  if (!met || probe_count_ == kProbes) return;
  const MonoTime moment = newest_.time + ahead_;
  // What is asked for nearer than what waits already comes when that has come.
  if (probe_count_ > 0 && moment <= probes_[(first_probe_ + probe_count_ - 1) % kProbes].moment)
    return;
  Pose pose;
  extrapolator.predict(moment, pose);
  probes_[(first_probe_ + probe_count_) % kProbes] = {moment, *met, shape_of(pose).figure,
                                                      static_cast<float>(ahead_.as_seconds())};
  ++probe_count_;
}

void PartnerGuide::guide(MonoTime moment, Pose& pose) const {
  if (strength_ <= 0.0f) return;
  const auto met = meeting();
  if (!met) return;
  const PartnerTrack* beside = track();
  const auto partner = beside->at_latest(moment + lag_);
  if (!partner) return;
  // A partner who is not seen any more is let go.
  const double unseen_s =
      (moment + lag_ - beside->newest().time - PartnerTrack::kAhead).as_seconds();
  const auto seen = static_cast<float>(std::clamp(1.0 - unseen_s / kPartnerLetGo_s, 0.0, 1.0));
  if (seen <= 0.0f) return;
  auto pulls = holds_.pulls(*met, shape_of(pose).figure,
                            static_cast<float>((moment - newest_.time).as_seconds()), *partner);
  for (PalmPull& pull : pulls) pull.share *= strength_ * seen;
  pull_palms(skeleton_, pulls, pose);
}

std::optional<std::array<PalmGuesses, 2>> PartnerGuide::guesses(MonoTime moment,
                                                                const Pose& pose) const {
  const auto met = meeting();
  if (!met) return std::nullopt;
  const auto partner = track()->at_latest(moment + lag_);
  if (!partner) return std::nullopt;
  const Figure predicted = shape_of(pose).figure;
  const auto ahead_s = static_cast<float>((moment - newest_.time).as_seconds());
  return std::array{PalmGuesses::of(*met, predicted, ahead_s, *partner, 0),
                    PalmGuesses::of(*met, predicted, ahead_s, *partner, 1)};
}

}  // namespace dance
