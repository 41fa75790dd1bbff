#include "producers/trackers/net/tracker_net.h"

#include <cmath>

namespace dance {
namespace {

using Eigen::MatrixXf;
using Eigen::VectorXf;

// y += M x, without a temporary. Points that are not tracked cost nothing.
void add_product(const MatrixXf& m, const float* x, VectorXf& y) {
  for (Eigen::Index j = 0; j < m.cols(); ++j)
    if (x[j] != 0.0f) y.noalias() += x[j] * m.col(j);
}

}  // namespace

TrackerNet::TrackerNet() {
  Eigen::Index inputs = TrackerRow::kInputs;
  for (Layer& layer : layers) {
    layer.in = MatrixXf::Zero(kGates, inputs);
    layer.again = MatrixXf::Zero(kGates, kUnits);
    layer.in_bias = VectorXf::Zero(kGates);
    layer.again_bias = VectorXf::Zero(kGates);
    inputs = kUnits;
  }
  out = MatrixXf::Zero(TrackerRow::kOutputs, kUnits);
  out_bias = VectorXf::Zero(TrackerRow::kOutputs);
}

TrackerNet::State::State() : in(VectorXf::Zero(kGates)), again(VectorXf::Zero(kGates)) {
  units.fill(VectorXf::Zero(kUnits));
}

void TrackerNet::State::clear() {
  for (VectorXf& u : units) u.setZero();
  outputs.fill(0.0f);
}

void TrackerNet::step(const TrackerRow::Inputs& inputs, State& state) const {
  const float* below = inputs.data();
  for (std::size_t l = 0; l < layers.size(); ++l) {
    const Layer& layer = layers[l];
    VectorXf& h = state.units[l];
    state.in = layer.in_bias;
    add_product(layer.in, below, state.in);
    state.again = layer.again_bias;
    add_product(layer.again, h.data(), state.again);
    const auto part = [](VectorXf& all, int which) {
      return all.segment(which * kUnits, kUnits).array();
    };
    const auto sigmoid = [](auto x) { return (1.0f + (-x).exp()).inverse(); };
    part(state.in, 0) = sigmoid(part(state.in, 0) + part(state.again, 0));
    part(state.in, 1) = sigmoid(part(state.in, 1) + part(state.again, 1));
    part(state.in, 2) = (part(state.in, 2) + part(state.in, 1) * part(state.again, 2)).tanh();
    h.array() = (1.0f - part(state.in, 0)) * part(state.in, 2) + part(state.in, 0) * h.array();
    below = h.data();
  }
  Eigen::Map<VectorXf> says(state.outputs.data(), TrackerRow::kOutputs);
  says = out_bias;
  for (Eigen::Index j = 0; j < out.cols(); ++j) says.noalias() += below[j] * out.col(j);
}

}  // namespace dance
