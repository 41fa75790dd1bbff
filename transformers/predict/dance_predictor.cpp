#include "transformers/predict/dance_predictor.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "transformers/predict/model/row_kernels.h"
#include "transformers/predict/past/motion_bounds.h"

namespace dance {
namespace {

constexpr std::size_t kPriorRows = 32;  // how often the weights hear of the trembling
// A dancer was just met until here, and has a past this much later.
constexpr float kYoung_rows = 240.0f, kGrowing_rows = 360.0f;
constexpr std::size_t kSolveRows = 2;  // a horizon's weights are solved every 16 rows
// How fast what lies between two rows is forgotten.
constexpr double kSeenKept_rows = 6.0;

constexpr std::array<double, kHorizons + 1> kKnots{0, 3, 6, 9, 12, 18, 24, 36, 60};

// What each of the knots counts on a smooth curve through them, at `rows` ahead: cubic between two,
// their slopes from the knots on both sides.
std::array<float, kHorizons + 1> knot_weights(double rows) {
  std::array<double, kHorizons + 1> weights{};
  std::size_t k = 0;
  while (k + 2 < kKnots.size() && rows > kKnots[k + 1]) ++k;
  const double step = kKnots[k + 1] - kKnots[k];
  const double t = std::clamp((rows - kKnots[k]) / step, 0.0, 1.0);
  const double t2 = t * t, t3 = t2 * t;
  weights[k] += 2.0 * t3 - 3.0 * t2 + 1.0;
  weights[k + 1] += 3.0 * t2 - 2.0 * t3;
  const auto add_slope = [&](std::size_t at, double weight) {
    const std::size_t before = at == 0 ? 0 : at - 1;
    const std::size_t after = std::min(at + 1, kKnots.size() - 1);
    const double per = weight * step / (kKnots[after] - kKnots[before]);
    weights[after] += per;
    weights[before] -= per;
  };
  add_slope(k, t3 - 2.0 * t2 + t);
  add_slope(k + 1, t3 - t2);
  std::array<float, kHorizons + 1> out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(weights[i]);
  return out;
}

}  // namespace

DancePredictor::DancePredictor(std::shared_ptr<const PredictModel> model)
    : model_(std::move(model)),
      space_(model_->centres),
      rows_(space_),
      memory_(model_->lever),
      guard_(model_->lever),
      personal_(std::make_shared<PersonalModel>(model_)),
      moments_(kMoments) {
  set_prior();
}

void DancePredictor::set_acquaintance(Acquaintance acquaintance) {
  acquaintance_ = acquaintance;
  personal_->set_asks_net(acquaintance != Acquaintance::kNone);
  set_prior();
}

void DancePredictor::set_prior() {
  // Between the weights for a still and for a trembling sensor, by what is measured.
  const float still = model_->tremble_rad[0], trembling = model_->tremble_rad[1];
  const float part = std::clamp((rows_.tremble_rad() - still) / (trembling - still), 0.0f, 1.0f);
  // And between those for a dancer just met and for one with a past to look at.
  const float seen =
      std::clamp((static_cast<float>(memory_.size()) - kYoung_rows) / kGrowing_rows, 0.0f, 1.0f);
  const auto between = [](float a, float b, float share) { return a + share * (b - a); };
  const auto weight = [&](Acquaintance who, std::size_t kind, std::size_t h, std::size_t e) {
    const auto& w = model_->weights[static_cast<std::size_t>(who)];
    return between(between(w[0][0][kind][h][e], w[0][1][kind][h][e], part),
                   between(w[1][0][kind][h][e], w[1][1][kind][h][e], part), seen);
  };
  KindWeights prior;
  for (std::size_t h = 0; h < kHorizons; ++h) {
    // The network together with a personal model that has proved itself knows this dancer.
    const float known =
        acquaintance_ == Acquaintance::kOthers ? proof_.proved(h, newest_.presence) : 0.0f;
    for (std::size_t kind = 0; kind < kWeightKinds; ++kind)
      for (std::size_t e = 0; e < kPredictions; ++e)
        prior[kind][h][e] = between(weight(acquaintance_, kind, h, e),
                                    weight(Acquaintance::kDancer, kind, h, e), known);
  }
  blend_.set_prior(prior);
}

void DancePredictor::forget_dancer() {
  rows_.forget();
  blend_.clear();
  proof_.clear();
  guard_.clear();
  personal_->forget();
}

SteadyRows::Heard DancePredictor::observe(const Pose& pose) {
  const SteadyRows::Heard heard = rows_.observe(pose);
  if (heard == SteadyRows::Heard::kRefused) return heard;
  const bool jumps = has_newest_ && (pose.clock_id != newest_.clock_id ||
                                     pose.capture_time < newest_.capture_time);
  newest_ = pose;
  has_newest_ = true;
  if (heard == SteadyRows::Heard::kRestarted) {
    memory_.clear();
    mean_.clear();
    // After a mere gap it is the same dancer, whose ways are still those that were proved.
    if (jumps) {
      proof_.clear();
      guard_.clear();
      blend_.clear();
    } else {
      guard_.forget_lately();
    }
    set_prior();
    since_ = 0;
    anew_ = true;
  }
  BodyRow row;
  while (rows_.next(row)) take(row);
  note_seen();
  return heard;
}

double DancePredictor::rows_ahead(MonoTime moment) const {
  return std::clamp(moment - rows_.row_time(), Duration(), kFurthest).as_seconds() * kGridHz;
}

void DancePredictor::note_seen() {
  seen_rows_ = memory_.size() > 0 ? rows_ahead(rows_.seen_time()) : 0.0;
  if (seen_rows_ <= 0.0) return;
  const BodyRow predicted = row_at(seen_rows_);
  for (std::size_t i = 0; i < kRowSize; ++i) seen_beside_.v[i] = rows_.seen().v[i] - predicted.v[i];
}

const MomentPredictions& DancePredictor::predictions(std::size_t age) const {
  DANCE_ASSERT(age < kMoments, age);
  return moments_[(turn_ - age) % kMoments];
}

void DancePredictor::take(const BodyRow& row) {
  memory_.push(row);
  mean_.push(memory_);
  personal_->push(row, rows_.tremble_rad(), anew_);
  anew_ = false;
  ++turn_;
  ++since_;
  if (turn_ % kPriorRows == 0) set_prior();
  MomentPredictions& now = moments_[turn_ % kMoments];
  make_predictions(memory_, mean_, now);
  ask_models(now);
  learn_from_past();
  make_ways(now);
}

void DancePredictor::ask_models(MomentPredictions& now) {
  const auto clear = [](BodyWays& ways) {
    for (BodyRow& way : ways) way.v.fill(0.0f);
  };
  const bool asks_net = acquaintance_ != Acquaintance::kNone;
  if (memory_.size() < kNetHistory) {
    clear(now.impersonal);
    clear(now.personal);
    return;
  }
  net_inputs(memory_, rows_.tremble_rad(), inputs_);
  model_->net.normalise(inputs_);
  bool is_new = false;
  const PersonalModel::Weights* weights = personal_->weights(is_new);
  if (is_new) proof_.discount_personal();
  alignas(64) NetAnswers personal{}, answers;
  if (weights)
    add_product(inputs_.data(), kNetInputs, weights->data(), kNetAnswers, personal.data());
  if (asks_net) model_->net.answer(inputs_, answers);
  if (weights && asks_net) {
    model_->net.ways_of(answers, now.impersonal, personal, now.personal);
  } else if (asks_net) {
    model_->net.ways_of(answers, now.impersonal);
    clear(now.personal);
  } else {
    clear(now.impersonal);
    if (weights)
      model_->net.ways_of(personal, now.personal);
    else
      clear(now.personal);
  }
  if (!asks_net) return;
  for (std::size_t h = 0; h < kHorizons; ++h) {
    BodyRow& way =
        now.by_horizon[h][static_cast<std::size_t>(Prediction::kNet) - kCommonPredictions];
    way = now.impersonal[h];
    proof_.add_personal(h, now, way);
  }
}

void DancePredictor::learn_from_past() {
  // Every other row a horizon: neighbours hardly differ.
  for (std::size_t h = turn_ % 2; h < kHorizons; h += 2) {
    const auto age = static_cast<std::size_t>(kHorizonFrames[h]);
    if (since_ < kNetHistory + age) continue;
    const MomentPredictions& then = moments_[(turn_ - age) % kMoments];
    BodyRow way = way_between(memory_(age), memory_(0));
    if (!bound_motion(h, way)) ++dropped_;
    blend_.learn(h, then, way);
    proof_.learn(h, then, way);
    guard_.learn(h, then, way);
  }
  if (turn_ % kSolveRows == 0) blend_.solve(turn_ / kSolveRows % kHorizons);
}

void DancePredictor::make_ways(MomentPredictions& now) {
  path_[0].v.fill(0.0f);
  for (std::size_t h = 0; h < kHorizons; ++h) {
    blend_.blend(h, now, now.blended[h]);
    if (acquaintance_ == Acquaintance::kNone) {
      now.impersonal[h] = now.blended[h];
      proof_.add_personal(h, now, now.blended[h]);
    }
    if (!bound_motion(h, now.blended[h])) ++dropped_;
    BodyRow& way = path_[h + 1];
    guard_.finish(h, now, way);
    if (!bound_motion(h, way)) ++dropped_;
    for (std::size_t b = 0; b < kBoneCount; ++b)
      if ((newest_.presence >> b & 1u) == 0) way(b, 0) = way(b, 1) = way(b, 2) = 0.0f;
  }
}

BodyRow DancePredictor::row_at(double rows_ahead) const {
  const auto weights = knot_weights(rows_ahead);
  BodyRow row;
  for (std::size_t k = 0; k < weights.size(); ++k)
    if (weights[k] != 0.0f) add_scaled(weights[k], path_[k].v.data(), kRowSize, row.v.data());
  const BodyRow& now = memory_(0);
  place_from_heading(row, now.heading());
  add_scaled(1.0f, now.v.data(), kRowSize, row.v.data());
  return row;
}

void DancePredictor::predict(MonoTime moment, Pose& out) const {
  const double rows = rows_ahead(moment);
  BodyRow row = row_at(rows);
  if (seen_rows_ > 0.0) {
    // What the newest pose shows is not lost.
    const auto kept =
        static_cast<float>(std::exp(-std::max(0.0, rows - seen_rows_) / kSeenKept_rows));
    add_scaled(kept, seen_beside_.v.data(), kRowSize, row.v.data());
  }
  out = newest_;
  space_.pose_of(row, out);
  out.capture_time = moment;
}

}  // namespace dance
