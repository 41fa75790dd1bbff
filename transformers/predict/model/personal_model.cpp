#include "transformers/predict/model/personal_model.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "transformers/predict/blend/moment_predictions.h"
#include "transformers/predict/model/row_kernels.h"

namespace dance {
namespace {

constexpr std::size_t kLongest = static_cast<std::size_t>(kHorizonFrames[kHorizons - 1]);
constexpr std::size_t kKept = 128;      // rows: the longest horizon and the inputs' history
constexpr std::size_t kEveryOther = 2;  // moments are taken in 30 times a second
constexpr std::size_t kBatch = 64;
constexpr std::uint64_t kMomentsASolve = 150;  // 5 s
constexpr std::uint64_t kFirstSolve = 150;
// (Z Zᵀ + ridge (n + first) I) W = Z Y, the inputs of standard deviation 1.
constexpr float kPersonalRidge = 0.2f;
constexpr float kPersonalFirst = 300.0f;
constexpr float kBatchKeep = 0.9975f;  // a half-life of ten minutes

using Matrix = Eigen::MatrixXf;

}  // namespace

struct PersonalModel::Sums {
  struct Moment {
    NetInputs inputs;
    NetAnswers answers;
    bool is_whole = false;
  };
  std::array<BodyRow, kKept> rows;
  std::array<Moment, kKept> moments;
  std::size_t newest = 0;  // counts down, as the rows' ages count up
  std::size_t size = 0;
  std::size_t turn = 0;
  Matrix batch_inputs{kNetInputs, kBatch}, batch_rest{kNetAnswers, kBatch};
  std::size_t batched = 0;
  Matrix gram = Matrix::Zero(kNetInputs, kNetInputs);
  Matrix cross = Matrix::Zero(kNetInputs, kNetAnswers);
  float heard = 0.0f;
  std::uint64_t solved_at = 0;
  std::uint32_t dancer = 0;

  const BodyRow& operator()(std::size_t age) const { return rows[(newest + age) % kKept]; }
};

PersonalModel::PersonalModel(std::shared_ptr<const PredictModel> model)
    : model_(std::move(model)),
      samples_(std::make_unique<SpscRing<Sample, kRing>>()),
      solved_(std::make_unique<Latest<Solved>>()),
      sums_(std::make_unique<Sums>()) {}

PersonalModel::~PersonalModel() = default;

void PersonalModel::push(const BodyRow& row, float tremble_rad, bool anew) {
  samples_->push({row, tremble_rad, anew, dancer_});
}

void PersonalModel::forget() {
  ++dancer_;
  newest_ = nullptr;
}

const PersonalModel::Weights* PersonalModel::weights(bool& is_new) {
  const Solved* taken = solved_->take();
  // What was solved may still be of the dancer before.
  is_new = taken && taken->dancer == dancer_;
  if (is_new) newest_ = &taken->weights;
  return newest_;
}

void PersonalModel::learn() {
  std::uint64_t lost = samples_->overwritten();
  // No more than the ring holds, however fast it is filled.
  for (std::size_t i = 0; i < kRing; ++i) {
    const auto sample = samples_->pop();
    if (!sample) break;
    if (samples_->overwritten() != lost) {
      lost = samples_->overwritten();
      sums_->size = 0;
    }
    take(*sample);
  }
  if (moments_ >= kFirstSolve && moments_ - sums_->solved_at >= kMomentsASolve) solve();
}

void PersonalModel::take(const Sample& sample) {
  Sums& s = *sums_;
  if (sample.dancer != s.dancer) begin_dancer(sample.dancer);
  if (sample.anew) s.size = 0;
  s.newest = (s.newest + kKept - 1) % kKept;
  s.rows[s.newest] = sample.row;
  s.size = std::min(s.size + 1, kKept);
  Sums::Moment& now = s.moments[s.newest];
  now.is_whole = s.size >= kNetHistory && ++s.turn % kEveryOther == 0;
  if (now.is_whole) {
    net_inputs(s, sample.tremble_rad, now.inputs);
    model_->net.normalise(now.inputs);
    now.answers.fill(0.0f);
    if (asks_net_.load(std::memory_order_relaxed)) model_->net.answer(now.inputs, now.answers);
  }
  if (s.size <= kLongest) return;
  const Sums::Moment& then = s.moments[(s.newest + kLongest) % kKept];
  if (!then.is_whole) return;
  // The way it went, as the basis has it: its rows are of length 1 where errors count as they
  // should.
  NetAnswers rest;
  for (std::size_t k = 0; k < kNetAnswers; ++k) rest[k] = -then.answers[k];
  for (std::size_t h = 0; h < kHorizons; ++h) {
    const BodyRow way =
        way_between(s(kLongest), s(kLongest - static_cast<std::size_t>(kHorizonFrames[h])));
    const float scale = 1.0f / (model_->horizon_scale[h] * model_->horizon_scale[h]);
    std::array<float, kRowSize> counted;
    for (std::size_t i = 0; i < kRowSize; ++i) {
      const float lever = model_->lever[i % kRowGroups];
      counted[i] = way.v[i] * lever * lever * scale;
    }
    const float* basis = model_->net.basis.data() + h * kNetAnswers * kRowSize;
    for (std::size_t k = 0; k < kNetAnswers; ++k)
      for (std::size_t i = 0; i < kRowSize; ++i) rest[k] += basis[k * kRowSize + i] * counted[i];
  }
  const auto column = static_cast<Eigen::Index>(s.batched);
  for (std::size_t i = 0; i < kNetInputs; ++i)
    s.batch_inputs(static_cast<Eigen::Index>(i), column) = then.inputs[i];
  for (std::size_t k = 0; k < kNetAnswers; ++k)
    s.batch_rest(static_cast<Eigen::Index>(k), column) = rest[k];
  ++moments_;
  if (++s.batched == kBatch) take_in_batch();
}

void PersonalModel::begin_dancer(std::uint32_t dancer) {
  Sums& s = *sums_;
  s.dancer = dancer;
  s.size = s.batched = 0;
  s.gram.setZero();
  s.cross.setZero();
  s.heard = 0.0f;
  s.solved_at = moments_ = 0;
}

void PersonalModel::take_in_batch() {
  Sums& s = *sums_;
  const auto count = static_cast<Eigen::Index>(s.batched);
  if (count == 0) return;
  s.gram *= kBatchKeep;
  s.cross *= kBatchKeep;
  s.gram.selfadjointView<Eigen::Lower>().rankUpdate(s.batch_inputs.leftCols(count));
  s.cross.noalias() += s.batch_inputs.leftCols(count) * s.batch_rest.leftCols(count).transpose();
  s.heard = kBatchKeep * s.heard + static_cast<float>(count);
  s.batched = 0;
}

void PersonalModel::solve() {
  Sums& s = *sums_;
  take_in_batch();
  s.solved_at = moments_;
  Matrix held = s.gram;
  held.diagonal().array() += kPersonalRidge * (s.heard + kPersonalFirst);
  const Eigen::LLT<Matrix> decomposed(held);
  if (decomposed.info() != Eigen::Success) return;
  const Matrix solved = decomposed.solve(s.cross);
  if (!solved.allFinite()) return;
  auto result = std::make_unique<Solved>();
  result->dancer = s.dancer;
  for (std::size_t i = 0; i < kNetInputs; ++i)
    for (std::size_t k = 0; k < kNetAnswers; ++k)
      result->weights[i * kNetAnswers + k] =
          solved(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
  solved_->put(*result);
}

}  // namespace dance
