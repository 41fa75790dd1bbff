// The operations of a network by their definitions, as slow as it comes.
#include <algorithm>
#include <cmath>
#include <map>

#include "tests/producers/camera/estimator/tiny_network.h"

namespace dance {
namespace {

float sigmoid_of(float x) { return 1.0f / (1.0f + std::exp(-x)); }

struct Picture {
  Shape shape;
  std::vector<float> values;
  // 0 beyond the border.
  float at(int row, int column, int channel) const {
    if (row < 0 || column < 0 || row >= shape[1] || column >= shape[2]) return 0.0f;
    return values[static_cast<std::size_t>((row * shape[2] + column) * shape[3] + channel)];
  }
};

float convolved(const PoseGraph& graph, const GraphNode& n, const Picture& in, int row, int column,
                int channel) {
  const bool is_depthwise = n.op == GraphOp::kDepthwise;
  const std::vector<float>& weights = graph.values(n.weights);
  const int inputs = in.shape[3];
  double sum = graph.values(n.bias)[static_cast<std::size_t>(channel)];
  for (int r = 0; r < n.kernel_rows; ++r) {
    for (int c = 0; c < n.kernel_columns; ++c) {
      const int y = row * n.stride_rows - n.pad_top + r;
      const int x = column * n.stride_columns - n.pad_left + c;
      for (int i = 0; i < (is_depthwise ? 1 : inputs); ++i) {
        const int place = is_depthwise
                              ? (r * n.kernel_columns + c) * inputs + channel
                              : ((channel * n.kernel_rows + r) * n.kernel_columns + c) * inputs + i;
        sum += static_cast<double>(weights[static_cast<std::size_t>(place)]) *
               in.at(y, x, is_depthwise ? channel : i);
      }
    }
  }
  return static_cast<float>(sum);
}

float pooled(const GraphNode& n, const Picture& in, int row, int column, int channel) {
  float most = -1e30f;
  for (int r = 0; r < n.kernel_rows; ++r)
    for (int c = 0; c < n.kernel_columns; ++c)
      most = std::max(most, in.at(row * n.stride_rows + r, column * n.stride_columns + c, channel));
  return most;
}

float resized(const Picture& in, const Shape& to, int row, int column, int channel) {
  const auto place = [](int i, int from, int size) {
    const double at = (i + 0.5) * from / size - 0.5;
    return std::clamp(at, 0.0, static_cast<double>(from - 1));
  };
  const double y = place(row, in.shape[1], to[1]), x = place(column, in.shape[2], to[2]);
  double sum = 0.0;
  for (int r = 0; r < in.shape[1]; ++r)
    for (int c = 0; c < in.shape[2]; ++c)
      sum += std::max(0.0, 1.0 - std::abs(y - r)) * std::max(0.0, 1.0 - std::abs(x - c)) *
             in.at(r, c, channel);
  return static_cast<float>(sum);
}

float value_of(const PoseGraph& graph, const GraphNode& n, const std::vector<Picture>& in,
               const Shape& to, int row, int column, int channel) {
  switch (n.op) {
    case GraphOp::kConvolution:
    case GraphOp::kDepthwise:
      return convolved(graph, n, in[0], row, column, channel);
    case GraphOp::kAdd:
      return in[0].at(row, column, channel) + in[1].at(row, column, channel);
    case GraphOp::kPad: {
      const int c = channel - n.pad_before[3];
      const bool is_inside = c >= 0 && c < in[0].shape[3];
      return is_inside ? in[0].at(row - n.pad_before[1], column - n.pad_before[2], c) : 0.0f;
    }
    case GraphOp::kMaxPool:
      return pooled(n, in[0], row, column, channel);
    case GraphOp::kResizeBilinear:
      return resized(in[0], to, row, column, channel);
    case GraphOp::kDepthToSpace: {
      const int block = (row % n.block) * n.block + column % n.block;
      return in[0].at(row / n.block, column / n.block, block * to[3] + channel);
    }
    case GraphOp::kLogistic:
      return sigmoid_of(in[0].at(row, column, channel));
    case GraphOp::kClamp:
      return in[0].at(row, column, channel);
    case GraphOp::kPrelu: {
      const float x = in[0].at(row, column, channel);
      return x < 0.0f ? x * graph.values(n.weights)[static_cast<std::size_t>(channel)] : x;
    }
    case GraphOp::kReshape:
    case GraphOp::kConcatenate:
    case GraphOp::kMean:
    case GraphOp::kFullyConnected:
      break;
  }
  return 0.0f;
}

std::vector<float> means(const Picture& in) {
  std::vector<float> means;
  for (int channel = 0; channel < in.shape[3]; ++channel) {
    double sum = 0.0;
    for (int row = 0; row < in.shape[1]; ++row)
      for (int column = 0; column < in.shape[2]; ++column) sum += in.at(row, column, channel);
    means.push_back(static_cast<float>(sum / (in.shape[1] * in.shape[2])));
  }
  return means;
}

std::vector<float> connected(const PoseGraph& graph, const GraphNode& n, const Picture& in) {
  std::vector<float> out;
  const std::vector<float>& weights = graph.values(n.weights);
  for (std::size_t o = 0; o < graph.values(n.bias).size(); ++o) {
    double sum = graph.values(n.bias)[o];
    for (std::size_t i = 0; i < in.values.size(); ++i)
      sum += static_cast<double>(weights[o * in.values.size() + i]) * in.values[i];
    out.push_back(std::clamp(static_cast<float>(sum), n.least, n.most));
  }
  return out;
}

}  // namespace

std::vector<std::vector<float>> computed_plainly(const PoseGraph& graph,
                                                 const std::vector<float>& input) {
  std::map<int, Picture> made;
  made[graph.input] = {graph.shape(graph.input), input};
  for (const GraphNode& n : graph.nodes) {
    std::vector<Picture> in;
    for (const int t : n.inputs) in.push_back(made.at(t));
    Picture out{graph.shape(n.output), {}};
    if (n.op == GraphOp::kMean) {
      out.values = means(in[0]);
    } else if (n.op == GraphOp::kFullyConnected) {
      out.values = connected(graph, n, in[0]);
    } else if (n.op == GraphOp::kLogistic && out.shape.size() == 2) {
      for (const float x : in[0].values) out.values.push_back(sigmoid_of(x));
    } else if (n.op == GraphOp::kReshape || n.op == GraphOp::kConcatenate) {
      for (const Picture& part : in)
        out.values.insert(out.values.end(), part.values.begin(), part.values.end());
    } else {
      const Shape& to = out.shape;
      for (int row = 0; row < to[1]; ++row)
        for (int column = 0; column < to[2]; ++column)
          for (int channel = 0; channel < to[3]; ++channel)
            out.values.push_back(
                std::clamp(value_of(graph, n, in, to, row, column, channel), n.least, n.most));
    }
    made[n.output] = std::move(out);
  }
  std::vector<std::vector<float>> outputs;
  for (const int t : graph.outputs) outputs.push_back(made.at(t).values);
  return outputs;
}

}  // namespace dance
