#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/random.h"
#include "research/matrix_product.h"
#include "research/predict/predict_training.h"

namespace dance {
namespace {

using Matrix = Eigen::MatrixXf;
using Numbers = BodyNet::Numbers;

constexpr std::size_t kNetBatch = 512;
constexpr float kStraightRidge = 0.1f;
constexpr float kStep = 1e-3f, kStraightStep = 3e-4f;
constexpr float kWeightDecay = 0.01f;
constexpr float kMomentum = 0.9f, kSquares = 0.999f;
constexpr float kDropHidden = 0.3f, kDropInput = 0.12f;

// Adam with decay of the weights beside it (Loshchilov and Hutter, 2019).
class Adam {
 public:
  explicit Adam(Numbers& numbers)
      : numbers_(&numbers), mean_(numbers.size()), square_(numbers.size()) {}
  void step(const Numbers& gradient, float rate, float decay, std::uint64_t turn) {
    const float a = 1.0f / (1.0f - std::pow(kMomentum, static_cast<float>(turn)));
    const float b = 1.0f / (1.0f - std::pow(kSquares, static_cast<float>(turn)));
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      mean_[i] += (1.0f - kMomentum) * (gradient[i] - mean_[i]);
      square_[i] += (1.0f - kSquares) * (gradient[i] * gradient[i] - square_[i]);
      float& x = (*numbers_)[i];
      x -= rate * (a * mean_[i] / (std::sqrt(b * square_[i]) + 1e-8f) + decay * x);
    }
  }

 private:
  Numbers* numbers_;
  Numbers mean_, square_;
};

void transpose(const Numbers& from, std::size_t rows, std::size_t columns, Numbers& to) {
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) to[j * rows + i] = from[i * columns + j];
}

// What a batch of moments becomes on its way through the network, and its error on the way back.
struct Pass {
  Numbers inputs = Numbers(kNetBatch * kNetInputs);
  Numbers one = Numbers(kNetBatch * kNetHidden), two = one;
  Numbers one_kept = one, two_kept = one;  // dropped: 0; kept: 1 / (1 - share)
  Numbers answers = Numbers(kNetBatch * kNetAnswers);
  Numbers one_error = one, two_error = one;
};

class NetTrainer {
 public:
  NetTrainer(BodyNet& net, std::uint64_t seed) : net_(net), random_(seed) {
    begin(net.first, kNetInputs, 1.0);
    begin(net.second, kNetHidden, 1.0);
    begin(net.third, kNetHidden, 0.1);
  }

  // `error` is the mean squared one of the batch before this step.
  void step(const Numbers& targets, float rate, double& error) {
    forward();
    Pass& p = pass_;
    error = 0.0;
    for (std::size_t s = 0; s < kNetBatch; ++s) {
      float* answer = &p.answers[s * kNetAnswers];
      float square = 0.0f;
      for (std::size_t k = 0; k < kNetAnswers; ++k) {
        answer[k] -= targets[s * kNetAnswers + k];
        square += answer[k] * answer[k];
      }
      error += static_cast<double>(square);
      // What a moment is off by counts as it is, not as its square: a leap is not to outweigh ten
      // steps. All horizons' ways together have a mean square of one each.
      const float counts = 1.0f / std::sqrt(1.0f + square);
      for (std::size_t k = 0; k < kNetAnswers; ++k)
        answer[k] *= 2.0f * counts / static_cast<float>(kNetBatch);
    }
    error /= static_cast<double>(kNetBatch);
    backward(rate);
  }
  Pass& pass() { return pass_; }
  Random& random() { return random_; }

 private:
  void begin(Numbers& matrix, std::size_t inputs, double part) {
    const double sd = part * std::sqrt(2.0 / static_cast<double>(inputs));
    for (float& x : matrix) x = static_cast<float>(sd * random_.normal());
  }
  void layer(const Numbers& from, std::size_t inputs, const Numbers& matrix, const Numbers& bias,
             Numbers& to, Numbers& kept) {
    for (std::size_t s = 0; s < kNetBatch; ++s)
      std::copy(bias.begin(), bias.end(), to.begin() + static_cast<std::ptrdiff_t>(s * kNetHidden));
    add_matrix_product(from.data(), inputs, 1, matrix.data(), kNetHidden, to.data(), kNetBatch,
                       inputs, kNetHidden);
    for (std::size_t i = 0; i < to.size(); ++i) {
      const bool drops = static_cast<float>(random_.uniform()) < kDropHidden;
      kept[i] = to[i] <= 0.0f || drops ? 0.0f : 1.0f / (1.0f - kDropHidden);
      to[i] *= kept[i];
    }
  }
  void forward() {
    Pass& p = pass_;
    for (float& x : p.inputs)
      x *= static_cast<float>(random_.uniform()) < kDropInput ? 0.0f : 1.0f / (1.0f - kDropInput);
    layer(p.inputs, kNetInputs, net_.first, net_.first_bias, p.one, p.one_kept);
    layer(p.one, kNetHidden, net_.second, net_.second_bias, p.two, p.two_kept);
    for (std::size_t s = 0; s < kNetBatch; ++s)
      std::copy(net_.third_bias.begin(), net_.third_bias.end(),
                p.answers.begin() + static_cast<std::ptrdiff_t>(s * kNetAnswers));
    add_matrix_product(p.two.data(), kNetHidden, 1, net_.third.data(), kNetAnswers,
                       p.answers.data(), kNetBatch, kNetHidden, kNetAnswers);
    add_matrix_product(p.inputs.data(), kNetInputs, 1, net_.straight.data(), kNetAnswers,
                       p.answers.data(), kNetBatch, kNetInputs, kNetAnswers);
  }
  // gradient = fromᵀ error
  void learn(Adam& adam, const Numbers& from, std::size_t inputs, const Numbers& error,
             std::size_t outputs, float rate) {
    gradient_.assign(inputs * outputs, 0.0f);
    add_matrix_product(from.data(), 1, inputs, error.data(), outputs, gradient_.data(), inputs,
                       kNetBatch, outputs);
    adam.step(gradient_, rate, kWeightDecay, turn_);
  }
  void learn_bias(Adam& adam, const Numbers& error, std::size_t outputs, float rate) {
    gradient_.assign(outputs, 0.0f);
    for (std::size_t s = 0; s < kNetBatch; ++s)
      for (std::size_t j = 0; j < outputs; ++j) gradient_[j] += error[s * outputs + j];
    adam.step(gradient_, rate, 0.0f, turn_);
  }
  // The error before a layer: error · matrixᵀ, where it was kept.
  void back(const Numbers& error, std::size_t outputs, const Numbers& matrix, const Numbers& kept,
            Numbers& before) {
    transposed_.resize(matrix.size());
    transpose(matrix, kNetHidden, outputs, transposed_);
    std::fill(before.begin(), before.end(), 0.0f);
    add_matrix_product(error.data(), outputs, 1, transposed_.data(), kNetHidden, before.data(),
                       kNetBatch, outputs, kNetHidden);
    for (std::size_t i = 0; i < before.size(); ++i) before[i] *= kept[i];
  }
  void backward(float rate) {
    ++turn_;
    Pass& p = pass_;
    back(p.answers, kNetAnswers, net_.third, p.two_kept, p.two_error);
    back(p.two_error, kNetHidden, net_.second, p.one_kept, p.one_error);
    learn(straight_, p.inputs, kNetInputs, p.answers, kNetAnswers, rate * kStraightStep / kStep);
    learn(third_, p.two, kNetHidden, p.answers, kNetAnswers, rate);
    learn_bias(third_bias_, p.answers, kNetAnswers, rate);
    learn(second_, p.one, kNetHidden, p.two_error, kNetHidden, rate);
    learn_bias(second_bias_, p.two_error, kNetHidden, rate);
    learn(first_, p.inputs, kNetInputs, p.one_error, kNetHidden, rate);
    learn_bias(first_bias_, p.one_error, kNetHidden, rate);
  }

  BodyNet& net_;
  Random random_;
  Pass pass_;
  Numbers gradient_, transposed_;
  std::uint64_t turn_ = 0;
  Adam straight_{net_.straight}, first_{net_.first}, first_bias_{net_.first_bias};
  Adam second_{net_.second}, second_bias_{net_.second_bias};
  Adam third_{net_.third}, third_bias_{net_.third_bias};
};

void fit_normalisation(BodyNet& net, const NetSamples& samples) {
  for (std::size_t i = 0; i < kNetInputs; ++i) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t s = 0; s < samples.count; ++s) {
      const auto x = static_cast<double>(samples.inputs[s * kNetInputs + i]);
      sum += x;
      squares += x * x;
    }
    const double n = static_cast<double>(samples.count);
    const double sd = std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n)));
    net.mean[i] = static_cast<float>(sum / n);
    // What never moves says nothing.
    net.scale[i] = sd > 1e-5 ? static_cast<float>(1.0 / sd) : 0.0f;
  }
}

// The ways as the basis has them: answers = basis · way, both levered and counted by horizon.
Numbers answers_of(const PredictModel& model, const NetSamples& samples) {
  Numbers projection(kWaySize * kNetAnswers);
  for (std::size_t h = 0; h < kHorizons; ++h)
    for (std::size_t k = 0; k < kNetAnswers; ++k)
      for (std::size_t i = 0; i < kRowSize; ++i)
        projection[(h * kRowSize + i) * kNetAnswers + k] =
            model.net.basis[(h * kNetAnswers + k) * kRowSize + i] * model.lever[i % kRowGroups] /
            (model.horizon_scale[h] * model.horizon_scale[h]);
  Numbers answers(samples.count * kNetAnswers);
  add_matrix_product(samples.ways.data(), kWaySize, 1, projection.data(), kNetAnswers,
                     answers.data(), samples.count, kWaySize, kNetAnswers);
  return answers;
}

// Where the straight part begins: ridge regression.
void fit_straight(BodyNet& net, const Numbers& inputs, const Numbers& answers, std::size_t count) {
  Numbers gram(kNetInputs * kNetInputs), cross(kNetInputs * kNetAnswers);
  add_matrix_product(inputs.data(), 1, kNetInputs, inputs.data(), kNetInputs, gram.data(),
                     kNetInputs, count, kNetInputs);
  add_matrix_product(inputs.data(), 1, kNetInputs, answers.data(), kNetAnswers, cross.data(),
                     kNetInputs, count, kNetAnswers);
  using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Matrix held = Eigen::Map<RowMajor>(gram.data(), kNetInputs, kNetInputs);
  held.diagonal().array() += kStraightRidge * static_cast<float>(count);
  Eigen::Map<RowMajor>(net.straight.data(), kNetInputs, kNetAnswers) =
      held.llt().solve(Matrix(Eigen::Map<RowMajor>(cross.data(), kNetInputs, kNetAnswers)));
}

}  // namespace

void fit_net(PredictModel& model, const NetSamples& samples, const NetFit& fit) {
  BodyNet& net = model.net;
  fit_normalisation(net, samples);
  Numbers inputs(samples.inputs.begin(), samples.inputs.end());
  for (std::size_t s = 0; s < samples.count; ++s) {
    NetInputs one;
    std::copy_n(&inputs[s * kNetInputs], kNetInputs, one.begin());
    net.normalise(one);
    std::copy(one.begin(), one.end(), &inputs[s * kNetInputs]);
  }
  const Numbers answers = answers_of(model, samples);
  fit_straight(net, inputs, answers, samples.count);
  NetTrainer trainer(net, fit.seed);
  std::vector<std::size_t> order(samples.count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t batches = samples.count / kNetBatch;
  Numbers targets(kNetBatch * kNetAnswers);
  for (int epoch = 0; epoch < fit.epochs; ++epoch) {
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[trainer.random().below(i)]);
    double error = 0.0;
    for (std::size_t b = 0; b < batches; ++b) {
      for (std::size_t s = 0; s < kNetBatch; ++s) {
        const std::size_t from = order[b * kNetBatch + s];
        std::copy_n(&inputs[from * kNetInputs], kNetInputs, &trainer.pass().inputs[s * kNetInputs]);
        std::copy_n(&answers[from * kNetAnswers], kNetAnswers, &targets[s * kNetAnswers]);
      }
      const double done =
          (epoch + static_cast<double>(b) / static_cast<double>(batches)) / fit.epochs;
      const double rate =
          static_cast<double>(kStep) * 0.5 * (1.0 + std::cos(3.14159265358979 * done));
      double batch_error = 0.0;
      trainer.step(targets, static_cast<float>(rate), batch_error);
      error += batch_error / static_cast<double>(std::max<std::size_t>(batches, 1));
    }
    if (fit.tell) fit.tell(epoch, error);
  }
}

}  // namespace dance
