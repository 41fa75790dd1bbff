// What stands behind parse_tflite(): walks the tables of one verified file and builds the graph,
// operation by operation.
//
// Units/frames: as producers/camera/estimator/pose_graph.h says.
// Ownership:    looks at the file's bytes; the graph that it returns owns its numbers.
// Threads:      none inside.
// Failure:      an Error says which operation is wrong, and how.
#pragma once

#include <optional>

#include "core/base/result.h"
#include "producers/camera/estimator/pose_graph.h"
#include "producers/camera/estimator/tflite_tensors.h"

namespace dance {

// The schema's numbers of the operations.
enum class TfliteBuiltin {
  kAdd = 0,
  kConcatenation = 2,
  kConv2d = 3,
  kDepthwiseConv2d = 4,
  kDepthToSpace = 5,
  kDequantize = 6,
  kFullyConnected = 9,
  kLogistic = 14,
  kMaxPool2d = 17,
  kRelu = 19,
  kReshape = 22,
  kResizeBilinear = 23,
  kPad = 34,
  kMean = 40,
  kStridedSlice = 45,
  kPrelu = 54,
  kDensify = 124,
};
class TfliteReader {
 public:
  explicit TfliteReader(const tflite::Model& verified) : model_(verified) {}
  Result<PoseGraph> read();

 private:
  struct Operator {
    const tflite::Operator* table = nullptr;
    std::vector<int> inputs;
    int output = -1;
  };
  using Done = Result<void>;

  Done read_operator(const tflite::Operator& table);
  Done take(TfliteBuiltin builtin, const Operator& op);
  Done take_same(const Operator& op);
  template <class Options>
  Done take_convolution(const Operator& op);
  Done take_pool(const Operator& op);
  Done take_add(const Operator& op);
  Done take_pad(const Operator& op);
  Done take_resize(const Operator& op);
  Done take_concatenation(const Operator& op);
  Done take_depth_to_space(const Operator& op);
  Done take_prelu(const Operator& op);
  Done take_mean(const Operator& op);
  Done take_fully_connected(const Operator& op);
  Done take_first_channels(const Operator& op);
  Done take_plain(const Operator& op, GraphOp kind);

  Done set_activation(GraphNode& node, int activation) const;
  // Where the window of kernel and stride goes over rows or columns: what is added before and after
  // them, and how often it fits.
  static Done place_window(int size, int kernel, int stride, int padding, int& before, int& after,
                           int& places);
  // A constant that the file does not have; returns its number.
  int add_constant(const char* name, Shape shape, std::vector<float> values);
  Done load(int tensor, const Shape& shape);
  Done push(GraphNode node, const Operator& op, std::size_t data_inputs, const Shape& shape);
  const Shape& shape(int tensor) const { return tensors_->shape(tensor); }

  const tflite::Model& model_;
  std::optional<TfliteTensors> tensors_;
  std::vector<bool> is_computed_;
  PoseGraph graph_;
};

}  // namespace dance
