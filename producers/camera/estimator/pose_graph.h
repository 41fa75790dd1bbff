// PoseGraph: a neural network as the engines run it: tensors, and the few operations that the
// networks of body, hands and face are made of, in the order in which they are computed. What a
// file leaves to be worked out (SAME padding, half-precision and sparse weights) is worked out
// here.
//
// Units/frames: tensors of four dimensions are batch (1), rows, columns, channels; weights of a
//               convolution are output channel, row, column, input channel; of a depthwise one 1,
//               row, column, channel.
// Ownership:    owns its numbers.
// Threads:      none inside.
// Failure:      none; the maker of one checks it: every shape follows from those before it, every
//               index is in range.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace dance {

using Shape = std::vector<int>;

inline std::size_t elements_of(const Shape& shape) {
  std::size_t product = 1;
  for (const int d : shape) product *= static_cast<std::size_t>(d);
  return product;
}

struct GraphTensor {
  std::string name;
  Shape shape;
  std::vector<float> values;  // of a constant; of one that is computed, empty
};

enum class GraphOp {
  kConvolution,
  kDepthwise,
  kAdd,
  kPad,
  kMaxPool,
  kResizeBilinear,  // half_pixel_centers
  kReshape,
  kLogistic,
  kConcatenate,  // along a dimension before which all are 1
  kDepthToSpace,
  kClamp,           // only between `least` and `most`
  kPrelu,           // x, or x times the weight of its channel where x < 0
  kMean,            // over rows and columns: one number a channel
  kFullyConnected,  // of 1 × numbers; weights are output × input
};

struct GraphNode {
  GraphOp op = GraphOp::kAdd;
  std::vector<int> inputs;  // tensors that are computed, or the graph's input
  int weights = -1;         // constants
  int bias = -1;
  int output = -1;
  int kernel_rows = 1, kernel_columns = 1;
  int stride_rows = 1, stride_columns = 1;
  // Added around rows and columns before a convolution or a pooling.
  int pad_top = 0, pad_bottom = 0, pad_left = 0, pad_right = 0;
  // Of kPad, for each dimension.
  std::array<int, 4> pad_before{}, pad_after{};
  int axis = 0;   // of kConcatenate
  int block = 1;  // of kDepthToSpace
  // The result is kept between these.
  float least = -std::numeric_limits<float>::infinity();
  float most = std::numeric_limits<float>::infinity();
};

struct PoseGraph {
  std::vector<GraphTensor> tensors;
  std::vector<GraphNode> nodes;
  int input = -1;
  std::vector<int> outputs;

  const Shape& shape(int tensor) const { return tensors[static_cast<std::size_t>(tensor)].shape; }
  const std::vector<float>& values(int tensor) const {
    return tensors[static_cast<std::size_t>(tensor)].values;
  }
};

// Leaves out what `outputs` do not need: they are the graph's outputs now, in that order.
void keep_outputs(PoseGraph& graph, const std::vector<int>& outputs);
// A kPad of rows and columns only goes into the convolutions behind it.
void fold_pads(PoseGraph& graph);

}  // namespace dance
