#include "producers/music/tracker/net/rhythm_net.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// No single moment proves anything.
constexpr float kMostRatio = 5.0f;

}  // namespace

RhythmNet::RhythmNet() {
  int inputs = kInputs;
  for (RecurrentLayer& layer : layers) {
    layer.in = Eigen::MatrixXf::Zero(3 * kUnits, inputs);
    layer.again = Eigen::MatrixXf::Zero(3 * kUnits, kUnits);
    layer.in_bias = Eigen::VectorXf::Zero(3 * kUnits);
    layer.again_bias = Eigen::VectorXf::Zero(3 * kUnits);
    inputs = kUnits;
  }
}

RhythmState::RhythmState()
    : in(Eigen::VectorXf::Zero(3 * RhythmNet::kUnits)),
      again(in),
      answer(Eigen::VectorXf::Zero(RhythmNet::kAnswers)),
      tempi(Eigen::VectorXf::Zero(RhythmNet::kTempi)) {
  units.fill(Eigen::VectorXf::Zero(RhythmNet::kUnits));
}

double RhythmNet::place_of_tempo(double bpm) {
  return (kTempi - 1) * std::log(bpm / kSlowest_bpm) / std::log(kFastest_bpm / kSlowest_bpm);
}

StrokeMeaning RhythmNet::step(std::span<const float, RhythmFeatures::kCount> features,
                              RhythmState& state) const {
  const auto sigmoid = [](auto x) { return (1.0f + (-x).exp()).inverse(); };
  Eigen::Map<const Eigen::VectorXf> x(features.data(), kInputs);
  for (std::size_t l = 0; l < kLayers; ++l) {
    const RecurrentLayer& layer = layers[l];
    Eigen::VectorXf& h = state.units[l];
    state.in = layer.in_bias;
    if (l == 0)
      state.in.noalias() += layer.in.lazyProduct(x);
    else
      state.in.noalias() += layer.in.lazyProduct(state.units[l - 1]);
    state.again = layer.again_bias;
    state.again.noalias() += layer.again.lazyProduct(h);
    auto part = [](Eigen::VectorXf& all, int which) {
      return all.segment(which * kUnits, kUnits).array();
    };
    part(state.in, 0) = sigmoid(part(state.in, 0) + part(state.again, 0));
    part(state.in, 1) = sigmoid(part(state.in, 1) + part(state.again, 1));
    part(state.in, 2) = (part(state.in, 2) + part(state.in, 1) * part(state.again, 2)).tanh();
    h.array() = (1.0f - part(state.in, 0)) * part(state.in, 2) + part(state.in, 0) * h.array();
  }
  state.answer = out_bias;
  state.answer.noalias() += out.lazyProduct(state.units.back());
  const auto tempi = state.answer.tail(kTempi).array();
  const float most = tempi.maxCoeff();
  state.tempi = tempi - (most + std::log((tempi - most).exp().sum()));
  const auto ratio = [&](int i) {
    return std::clamp(state.answer[i] - state.answer[2], -kMostRatio, kMostRatio);
  };
  return {ratio(0), ratio(1)};
}

}  // namespace dance
