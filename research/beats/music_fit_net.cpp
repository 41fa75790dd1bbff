#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/random.h"
#include "research/beats/music_training.h"

namespace dance {
namespace {

using Matrix = Eigen::MatrixXf;

constexpr Eigen::Index kBatch = 256;
constexpr float kFirstRate = 2e-3f;
constexpr float kLastRate = 1e-5f;
constexpr float kPull = 3e-5f;  // of each weight towards 0
constexpr float kDropInputs = 0.15f;
constexpr float kDropHidden = 0.3f;

class Adam {
 public:
  explicit Adam(Matrix& numbers)
      : numbers_(&numbers), mean_(Matrix::Zero(numbers.rows(), numbers.cols())), square_(mean_) {}
  void step(const Matrix& gradient, float rate, int turn) {
    mean_ += 0.1f * (gradient - mean_);
    square_ += 0.001f * (gradient.cwiseAbs2() - square_);
    const auto n = static_cast<float>(turn);
    const float a = rate / (1.0f - std::pow(0.9f, n));
    const float b = 1.0f / (1.0f - std::pow(0.999f, n));
    numbers_->array() -= a * mean_.array() / ((b * square_.array()).sqrt() + 1e-8f);
  }

 private:
  Matrix* numbers_;
  Matrix mean_;
  Matrix square_;
};

struct Moments {
  Matrix inputs;  // a column each, with mean 0 and deviation 1
  std::vector<std::uint8_t> classes;
  std::vector<float> weights;
  Eigen::VectorXf mean;
  Eigen::VectorXf scale;
};

Moments gather(const std::vector<const TrainingSong*>& songs) {
  Moments all;
  for (const TrainingSong* song : songs) {
    all.classes.insert(all.classes.end(), song->classes.begin(), song->classes.end());
    for (const float w : song->weights) all.weights.push_back(w * song->weight);
  }
  all.inputs.resize(StrokeNet::kInputs, static_cast<Eigen::Index>(all.classes.size()));
  Eigen::Index column = 0;
  for (const TrainingSong* song : songs) {
    const auto n = static_cast<Eigen::Index>(song->classes.size());
    all.inputs.middleCols(column, n) =
        Eigen::Map<const Matrix>(song->features.data(), StrokeNet::kInputs, n);
    column += n;
  }
  all.mean = all.inputs.rowwise().mean();
  all.inputs.colwise() -= all.mean;
  all.scale =
      (all.inputs.rowwise().squaredNorm() / static_cast<float>(column)).cwiseSqrt().array() + 1e-3f;
  all.inputs.array().colwise() /= all.scale.array();
  const float sum = std::accumulate(all.weights.begin(), all.weights.end(), 0.0f);
  for (float& w : all.weights) w *= static_cast<float>(column) / sum;
  return all;
}

class Trainer {
 public:
  Trainer(const Moments& moments, std::uint64_t seed) : moments_(moments), random_(seed) {
    const auto start = [&](Matrix& m, Eigen::Index rows, Eigen::Index columns) {
      m.resize(rows, columns);
      for (float& x : m.reshaped())
        x = static_cast<float>(random_.normal() / std::sqrt(static_cast<double>(columns)));
    };
    start(in_, StrokeNet::kHidden, StrokeNet::kInputs);
    start(out_, StrokeNet::kAnswers, StrokeNet::kHidden);
    in_bias_ = Matrix::Zero(StrokeNet::kHidden, 1);
    out_bias_ = Matrix::Zero(StrokeNet::kAnswers, 1);
  }

  StrokeNet train(const MusicTraining& training) {
    std::array adams{Adam(in_), Adam(in_bias_), Adam(out_), Adam(out_bias_)};
    std::vector<Eigen::Index> order(moments_.classes.size());
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    int turn = 0;
    for (int round = 0; round < training.rounds; ++round) {
      for (std::size_t i = order.size(); i > 1; --i)
        std::swap(order[i - 1], order[random_.below(i)]);
      const float rate =
          kFirstRate * (1.0f - static_cast<float>(round) / static_cast<float>(training.rounds)) +
          kLastRate;
      double loss = 0.0;
      const auto moments = static_cast<Eigen::Index>(order.size());
      const Eigen::Index batches = std::max(Eigen::Index{1}, moments / kBatch);
      for (Eigen::Index b = 0; b < batches; ++b) {
        const Eigen::Index n = std::min(kBatch, moments);
        loss += learn({order.data() + b * kBatch, static_cast<std::size_t>(n)});
        ++turn;
        adams[0].step(in_error_, rate, turn);
        adams[1].step(in_bias_error_, rate, turn);
        adams[2].step(out_error_, rate, turn);
        adams[3].step(out_bias_error_, rate, turn);
      }
      if (training.tell)
        training.tell(
            fmt::format("round {}: loss {:.4f}", round + 1, loss / static_cast<double>(batches)));
    }
    return net();
  }

 private:
  // 0 or 1 / (1 - share), at random.
  void draw(Matrix& mask, Eigen::Index rows, Eigen::Index columns, float share) {
    mask.resize(rows, columns);
    for (float& x : mask.reshaped())
      x = static_cast<float>(random_.uniform()) < share ? 0.0f : 1.0f / (1.0f - share);
  }

  double learn(std::span<const Eigen::Index> batch) {
    const auto n = static_cast<Eigen::Index>(batch.size());
    draw(mask_, StrokeNet::kInputs, n, kDropInputs);
    inputs_.resize(StrokeNet::kInputs, n);
    for (Eigen::Index i = 0; i < n; ++i)
      inputs_.col(i) = moments_.inputs.col(batch[static_cast<std::size_t>(i)]);
    inputs_.array() *= mask_.array();
    hidden_.noalias() = in_ * inputs_;
    hidden_.colwise() += in_bias_.col(0);
    draw(mask_, StrokeNet::kHidden, n, kDropHidden);
    mask_.array() *= (hidden_.array() > 0.0f).cast<float>();
    hidden_.array() *= mask_.array();
    answers_.noalias() = out_ * hidden_;
    answers_.colwise() += out_bias_.col(0);
    double loss = 0.0;
    float weights = 0.0f;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(batch[static_cast<std::size_t>(i)]);
      auto answer = answers_.col(i);
      answer = (answer.array() - answer.maxCoeff()).exp().matrix().eval();
      answer /= answer.sum();
      const float weight = moments_.weights[k];
      loss -= weight * std::log(std::max(answer[moments_.classes[k]], 1e-9f));
      answer[moments_.classes[k]] -= 1.0f;
      answer *= weight;
      weights += weight;
    }
    answers_ /= weights;
    hidden_error_.noalias() = out_.transpose() * answers_;
    hidden_error_.array() *= mask_.array();
    in_error_.noalias() = hidden_error_ * inputs_.transpose();
    in_error_ += kPull * in_;
    in_bias_error_ = hidden_error_.rowwise().sum();
    out_error_.noalias() = answers_ * hidden_.transpose();
    out_error_ += kPull * out_;
    out_bias_error_ = answers_.rowwise().sum();
    return loss / static_cast<double>(weights);
  }

  // Takes features as they are.
  StrokeNet net() const {
    StrokeNet net;
    net.in = in_;
    for (int i = 0; i < StrokeNet::kInputs; ++i) net.in.col(i) /= moments_.scale[i];
    net.in_bias = in_bias_ - net.in * moments_.mean;
    net.out = out_;
    net.out_bias = out_bias_;
    return net;
  }

  const Moments& moments_;
  Random random_;
  Matrix in_, in_bias_, out_, out_bias_;
  Matrix in_error_, in_bias_error_, out_error_, out_bias_error_;
  Matrix inputs_, hidden_, answers_, hidden_error_, mask_;
};

}  // namespace

StrokeNet fit_stroke_net(const std::vector<const TrainingSong*>& songs,
                         const MusicTraining& training) {
  const Moments moments = gather(songs);
  return Trainer(moments, training.seed).train(training);
}

}  // namespace dance
