#include "producers/salsa/salsa_score.h"

#include <cmath>
#include <utility>

#include "core/base/assert.h"
#include "core/base/random.h"
#include "producers/salsa/salsa_ease.h"
#include "producers/salsa/salsa_figures.h"

namespace dance {
namespace {

using salsa::radians;
using salsa::wrapped_angle;

constexpr double kClosedSpacing_m = 0.54;
constexpr double kOpenSpacing_m = 0.78;

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - ((a % b != 0 && (a < 0) != (b < 0)) ? 1 : 0);
}

std::uint64_t mixed(std::uint64_t seed, std::int64_t index) {
  return Random(seed ^ (static_cast<std::uint64_t>(index) * 0xd6e8feb86659fd93ULL)).next_u64();
}

const salsa::Row& row_of(SalsaFigure figure, SalsaRole role, int count) {
  const bool is_lead = role == SalsaRole::kLead;
  const auto own = static_cast<std::size_t>(count);
  const auto mirrored = static_cast<std::size_t>(is_lead ? count : (count + 4) % 8);
  switch (figure) {
    case SalsaFigure::kBasic:
      return salsa::kForwardAndBack[mirrored];
    case SalsaFigure::kSide:
      return salsa::kSideAndSide[mirrored];
    case SalsaFigure::kOpenBreak:
      return salsa::kBackAndBack[mirrored];
    case SalsaFigure::kCrossBodyLead:
      return (is_lead ? salsa::kCrossLead : salsa::kCrossFollow)[own];
    case SalsaFigure::kRightTurn:
      return (is_lead ? salsa::kTurnLead : salsa::kTurnFollow)[own];
  }
  DANCE_ASSERT(false, static_cast<int>(figure));
  return salsa::kForwardAndBack[0];
}

// The place so far to the left and ahead of another, facing the same way.
FloorPlace from(const FloorPlace& place, double left_m, double ahead_m) {
  const double cosine = std::cos(place.yaw_rad);
  const double sine = std::sin(place.yaw_rad);
  return {place.x_m + cosine * left_m + sine * ahead_m,
          place.z_m - sine * left_m + cosine * ahead_m, place.yaw_rad};
}

bool travels(SalsaFigure figure) {
  return figure == SalsaFigure::kCrossBodyLead || figure == SalsaFigure::kRightTurn;
}

SalsaHold standing_hold(bool is_closed) {
  SalsaHold hold;
  if (is_closed) hold = {.low = 0, .side = 1, .joined = 0, .embrace = 1};
  return hold;
}

// Counts are 0 to 7 here: on 0 and 1 the couple still holds as it ended the eight before.
SalsaHold hold_on(SalsaFigure figure, int count, bool was_closed, bool is_closed) {
  if (count < 2) return standing_hold(was_closed);
  if (figure == SalsaFigure::kRightTurn) {
    if (count == 2) return {.low = 0.6, .over = 0.4, .joined = 0.5, .free = 0.5, .flourish = 0.3};
    if (count == 3) return {.low = 0, .over = 1, .joined = 0, .free = 1, .flourish = 0.8};
    if (count < 6) return {.low = 0, .over = 1, .joined = 0, .free = 1, .flourish = 0};
    if (count == 6) return {.low = 0, .over = 1, .joined = 0, .free = 1, .flourish = 0.5};
    return {.low = 0.5, .over = 0.5, .joined = 0.3, .free = 0.7, .flourish = 1};
  }
  if (figure == SalsaFigure::kCrossBodyLead) {
    if (count == 2) return {.low = 0.3, .side = 0.7, .joined = 0, .embrace = 0.8, .free = 0.2};
    if (count == 3) return {.low = 0.3, .side = 0.7, .joined = 0, .embrace = 0.3, .free = 0.7};
    if (count == 4) return {.low = 0.3, .side = 0.7, .joined = 0, .free = 1, .flourish = 0.3};
    if (count == 5) return {.low = 0.5, .side = 0.5, .joined = 0, .free = 1, .flourish = 0.6};
    if (count == 6) return {.low = 1, .joined = 0, .free = 1, .flourish = 0.8};
    return {.low = 1, .joined = 0.6, .free = 0.4, .flourish = 0.4};
  }
  return standing_hold(is_closed);
}

}  // namespace

SalsaHold SalsaHold::operator+(const SalsaHold& o) const {
  return {low + o.low,         side + o.side, over + o.over,        joined + o.joined,
          embrace + o.embrace, free + o.free, flourish + o.flourish};
}
SalsaHold SalsaHold::operator*(double s) const {
  return {low * s, side * s, over * s, joined * s, embrace * s, free * s, flourish * s};
}
SalsaHold SalsaHold::operator-(const SalsaHold& o) const { return *this + o * -1.0; }

const SalsaCount& SalsaCounts::at(std::int64_t n) const {
  DANCE_ASSERT(n >= first_ && n <= last(), n, first_);
  return counts_[static_cast<std::size_t>(n - first_)];
}

SalsaScore::SalsaScore(const SalsaStyle& style) : style_(style) {
  DANCE_ASSERT(checked_style(style).has_value());
  drift_phase_rad_ = Random(style.seed ^ 0x5a15aULL).uniform(0.0, 2.0 * salsa::kPi);
  // Fast music is danced with smaller steps.
  step_scale_ = std::min(1.0, std::sqrt(190.0 / style.tempo_bpm)) * (0.5 + 0.5 * style.energy);
}

// A chorus is eight eights: a basic, then seven figures in an order of the seed's choice, two of
// which are cross body leads, so that both are at their first places again when the next chorus
// begins and the eights before need not be known.
SalsaScore::Eight SalsaScore::eight(std::int64_t index) const {
  using enum SalsaFigure;
  const std::int64_t chorus = floor_div(index, kEightsInChorus);
  const auto slot = static_cast<std::size_t>(index - chorus * kEightsInChorus);
  Random random(mixed(style_.seed, chorus));
  constexpr std::array<SalsaFigure, 4> kOthers{kBasic, kRightTurn, kSide, kOpenBreak};
  std::array<SalsaFigure, kEightsInChorus> figures{
      kBasic, kCrossBodyLead, kCrossBodyLead, kRightTurn, kSide, kOpenBreak, kBasic, kBasic};
  figures[7] = kOthers[random.below(kOthers.size())];
  for (std::size_t i = figures.size() - 1; i > 1; --i)
    std::swap(figures[i], figures[1 + random.below(i)]);

  Eight eight;
  eight.figure = figures[slot];
  for (std::size_t i = 0; i < slot; ++i) eight.is_swapped ^= figures[i] == kCrossBodyLead;

  Random own(mixed(style_.seed + 0x9e37ULL, index));
  const bool likes_closed = own.uniform() < 0.6;
  eight.is_closed = eight.figure == kSide || (eight.figure == kBasic && likes_closed);
  eight.spacing_m = eight.figure == kCrossBodyLead ? salsa::kCrossSpacing_m
                    : eight.figure == kRightTurn   ? salsa::kTurnSpacing_m
                    : eight.is_closed              ? kClosedSpacing_m
                                                   : kOpenSpacing_m;
  eight.step_gain = own.uniform(0.9, 1.1);
  eight.sway_gain = own.uniform(0.88, 1.12);
  return eight;
}

SalsaFigure SalsaScore::figure(std::int64_t index) const { return eight(index).figure; }

// The couple's frame wanders and turns slowly; the follow stands opposite the lead in it.
FloorPlace SalsaScore::own_frame(SalsaRole role, std::int64_t n, bool is_swapped,
                                 double spacing_m) const {
  const double slow = 2.0 * salsa::kPi * static_cast<double>(n) / 8.0 + 8.0 * drift_phase_rad_;
  const double turn_rad =
      radians(35.0) * std::sin(slow / 13.0) + radians(10.0) * std::sin(slow / 5.0);
  const double heading_rad = radians(style_.heading_deg);
  const FloorPlace place{style_.x_m, style_.z_m, heading_rad};
  const FloorPlace wandered =
      from(place, 0.10 * std::sin(slow / 11.0), 0.10 * std::cos(slow / 17.0));
  const bool is_turned = is_swapped != (role == SalsaRole::kFollow);
  const double yaw_rad = heading_rad + turn_rad + (is_turned ? salsa::kPi : 0.0);
  return from({wandered.x_m, wandered.z_m, yaw_rad}, 0.0, -0.5 * spacing_m);
}

SalsaCount SalsaScore::count(SalsaRole role, std::int64_t n, const Eight& before,
                             const Eight& now) const {
  const auto c = static_cast<int>(n - 8 * floor_div(n, 8));
  const salsa::Row& row = row_of(now.figure, role, c);
  const double gain = now.figure == SalsaFigure::kCrossBodyLead ? 1.0 : now.step_gain * step_scale_;
  // On 1 and 2 they still stand as far apart as the eight before left them.
  const FloorPlace own =
      own_frame(role, n, now.is_swapped, c < 2 ? before.spacing_m : now.spacing_m);
  SalsaCount count;
  count.is_step = c != 3 && c != 7;
  constexpr std::array<bool, 8> kLeadLeft{true, false, true, true, false, true, false, false};
  count.is_left = kLeadLeft[static_cast<std::size_t>(c)] == (role == SalsaRole::kLead);
  const double side = count.is_left ? 1.0 : -1.0;
  count.body = from(own, gain * row.body_x_m, gain * row.body_z_m);
  count.body.yaw_rad += radians(row.body_yaw_deg);
  count.foot = from(count.body, side * salsa::kHalfStance_m + gain * row.foot_x_m,
                    salsa::kBallAhead_m + gain * row.foot_z_m);
  count.foot.yaw_rad += side * radians(10.0);  // feet are turned out a little

  const bool is_walking = travels(now.figure) && c >= 4;
  count.sway = side * now.sway_gain * (is_walking ? 0.55 : 1.0) * (count.is_step ? 1.0 : 1.15);
  // The hip goes with its foot: a positive yaw takes the left hip back.
  count.hip_turn_rad = -side * 0.9 * gain * row.foot_z_m;
  count.heel_rad = row.foot_z_m < -0.05 ? 0.35 : 0.14;
  count.drop_m = 0.07 * gain * std::hypot(row.foot_x_m, row.foot_z_m);
  count.hold = hold_on(now.figure, c, before.is_closed, now.is_closed);
  return count;
}

void SalsaScore::counts_around(SalsaRole role, double beats, SalsaCounts& out) const {
  const std::int64_t first = static_cast<std::int64_t>(std::floor(beats)) - SalsaCounts::kBefore;
  if (out.is_filled_ && out.first_ == first) return;
  out.is_filled_ = true;
  out.first_ = first;
  std::int64_t index = floor_div(out.first_, 8);
  Eight before = eight(index - 1);
  Eight now = eight(index);
  double yaw_rad = 0.0;
  for (std::int64_t n = out.first_; n <= out.last(); ++n) {
    if (floor_div(n, 8) != index) {
      before = now;
      now = eight(++index);
    }
    SalsaCount count = this->count(role, n, before, now);
    const double foot_rad = wrapped_angle(count.foot.yaw_rad - count.body.yaw_rad);
    yaw_rad = n == out.first_ ? wrapped_angle(count.body.yaw_rad)
                              : yaw_rad + wrapped_angle(count.body.yaw_rad - yaw_rad);
    count.body.yaw_rad = yaw_rad;
    count.foot.yaw_rad = yaw_rad + foot_rad;
    out.counts_[static_cast<std::size_t>(n - out.first_)] = count;
  }
}

}  // namespace dance
