#include "research/beats/net_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "core/base/random.h"

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

class Trainer {
 public:
  Trainer(const NetMoments& moments, const NetSize& size, std::uint64_t seed)
      : moments_(moments), size_(size), random_(seed) {
    settle_inputs();
    const auto start = [&](Matrix& m, Eigen::Index rows, Eigen::Index columns) {
      m.resize(rows, columns);
      for (float& x : m.reshaped())
        x = static_cast<float>(random_.normal() / std::sqrt(static_cast<double>(columns)));
    };
    start(in_, size_.hidden, size_.inputs);
    start(out_, size_.answers, size_.hidden);
    in_bias_ = Matrix::Zero(size_.hidden, 1);
    out_bias_ = Matrix::Zero(size_.answers, 1);
  }

  FittedNet train(const MusicTraining& training) {
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
    draw(mask_, size_.inputs, n, kDropInputs);
    inputs_.resize(size_.inputs, n);
    for (Eigen::Index i = 0; i < n; ++i)
      inputs_.col(i) = settled_.col(batch[static_cast<std::size_t>(i)]);
    inputs_.array() *= mask_.array();
    hidden_.noalias() = in_ * inputs_;
    hidden_.colwise() += in_bias_.col(0);
    draw(mask_, size_.hidden, n, kDropHidden);
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
  FittedNet net() const {
    FittedNet net{in_, in_bias_, out_, out_bias_};
    for (Eigen::Index i = 0; i < size_.inputs; ++i) net.in.col(i) /= scale_[i];
    net.in_bias = in_bias_ - net.in * mean_;
    return net;
  }

  // To mean 0 and deviation 1.
  void settle_inputs() {
    const auto count = moments_.inputs.cols();
    mean_ = moments_.inputs.rowwise().mean();
    settled_ = moments_.inputs.colwise() - mean_;
    scale_ =
        (settled_.rowwise().squaredNorm() / static_cast<float>(count)).cwiseSqrt().array() + 1e-3f;
    settled_.array().colwise() /= scale_.array();
  }

  const NetMoments& moments_;
  NetSize size_;
  Random random_;
  Eigen::VectorXf mean_, scale_;
  Matrix settled_;
  Matrix in_, in_bias_, out_, out_bias_;
  Matrix in_error_, in_bias_error_, out_error_, out_bias_error_;
  Matrix inputs_, hidden_, answers_, hidden_error_, mask_;
};

}  // namespace

FittedNet fit_net(const NetMoments& moments, const NetSize& size, const MusicTraining& training) {
  return Trainer(moments, size, training.seed).train(training);
}

}  // namespace dance
