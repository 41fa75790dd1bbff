// The operations of a .tflite file, one by one, with everything checked that an engine relies on.
#include <algorithm>
#include <type_traits>

#include "producers/camera/estimator/tflite_reader.h"

namespace dance {
namespace {

constexpr int kSame = 0, kValid = 1;
constexpr int kNoActivation = 0, kRelu = 1, kRelu6 = 3;

constexpr const char* kNoOptions = "it has no options of its kind";

}  // namespace

Result<void> TfliteReader::take(TfliteBuiltin builtin, const Operator& op) {
  switch (builtin) {
    case TfliteBuiltin::kDequantize:
    case TfliteBuiltin::kDensify:
      return take_same(op);
    case TfliteBuiltin::kConv2d:
      return take_convolution<tflite::ConvolutionOptions>(op);
    case TfliteBuiltin::kDepthwiseConv2d:
      return take_convolution<tflite::DepthwiseOptions>(op);
    case TfliteBuiltin::kMaxPool2d:
      return take_pool(op);
    case TfliteBuiltin::kAdd:
      return take_add(op);
    case TfliteBuiltin::kPad:
      return take_pad(op);
    case TfliteBuiltin::kResizeBilinear:
      return take_resize(op);
    case TfliteBuiltin::kConcatenation:
      return take_concatenation(op);
    case TfliteBuiltin::kDepthToSpace:
      return take_depth_to_space(op);
    case TfliteBuiltin::kReshape:
      return take_plain(op, GraphOp::kReshape);
    case TfliteBuiltin::kLogistic:
      return take_plain(op, GraphOp::kLogistic);
    case TfliteBuiltin::kRelu:
      return take_plain(op, GraphOp::kClamp);
    case TfliteBuiltin::kPrelu:
      return take_prelu(op);
    case TfliteBuiltin::kMean:
      return take_mean(op);
    case TfliteBuiltin::kFullyConnected:
      return take_fully_connected(op);
    case TfliteBuiltin::kStridedSlice:
      return take_first_channels(op);
  }
  return fail("operation " + std::to_string(static_cast<int>(builtin)) + " is not known here");
}

Result<void> TfliteReader::take_same(const Operator& op) {
  if (!tensors_->is_constant(op.inputs[0])) return fail("what it unpacks is no constant");
  tensors_->set_same(op.inputs[0], op.output);
  return {};
}

Result<void> TfliteReader::set_activation(GraphNode& node, int activation) const {
  if (activation == kNoActivation) return {};
  if (activation != kRelu && activation != kRelu6)
    return fail("activation " + std::to_string(activation) + " is not known here");
  node.least = 0.0f;
  if (activation == kRelu6) node.most = 6.0f;
  return {};
}

Result<void> TfliteReader::place_window(int size, int kernel, int stride, int padding, int& before,
                                        int& after, int& places) {
  if (stride < 1 || stride > 16 || kernel < 1 || kernel > 64 ||
      (padding != kSame && padding != kValid))
    return fail("its window is " + std::to_string(kernel) + " wide and goes by steps of " +
                std::to_string(stride));
  before = after = 0;
  if (padding == kSame) {
    places = (size + stride - 1) / stride;
    const int missing = std::max((places - 1) * stride + kernel - size, 0);
    before = missing / 2;
    after = missing - before;
    return {};
  }
  if (kernel > size) return fail("its window is larger than the picture");
  places = (size - kernel) / stride + 1;
  return {};
}

Result<void> TfliteReader::load(int tensor, const Shape& due) {
  if (!tensors_->is_constant(tensor)) return fail("its weights are no constants");
  if (shape(tensor) != due) return fail("its weights are not of the due shape");
  auto& values = graph_.tensors[static_cast<std::size_t>(tensor)].values;
  if (values.empty()) {
    DANCE_TRY(values, tensors_->floats(tensor));
  }
  return {};
}

Result<void> TfliteReader::push(GraphNode node, const Operator& op, std::size_t data_inputs,
                                const Shape& due) {
  for (std::size_t i = 0; i < data_inputs; ++i) {
    if (!is_computed_[static_cast<std::size_t>(op.inputs[i])])
      return fail("it reads what is not computed yet");
    node.inputs.push_back(op.inputs[i]);
  }
  if (shape(op.output) != due) return fail("its result is not of the shape that the file says");
  node.output = op.output;
  is_computed_[static_cast<std::size_t>(op.output)] = true;
  graph_.nodes.push_back(std::move(node));
  return {};
}

template <class Options>
Result<void> TfliteReader::take_convolution(const Operator& op) {
  constexpr bool is_depthwise = std::is_same_v<Options, tflite::DepthwiseOptions>;
  const auto* o = op.table->options_as<Options>();
  if (!o) return fail(kNoOptions);
  if (op.inputs.size() != 3) return fail("a convolution has weights and a bias");
  const int in = op.inputs[0];
  GraphNode node;
  node.op = is_depthwise ? GraphOp::kDepthwise : GraphOp::kConvolution;
  node.weights = op.inputs[1];
  node.bias = op.inputs[2];
  const Shape& from = shape(in);
  const Shape& kernel = shape(node.weights);
  if (from.size() != 4 || kernel.size() != 4) return fail("a convolution has four dimensions");
  const int channels = is_depthwise ? kernel[3] : kernel[0];
  if (from[0] != 1 || kernel[is_depthwise ? 0 : 3] != (is_depthwise ? 1 : from[3]) ||
      (is_depthwise && channels != from[3]))
    return fail("its weights do not fit its input");
  if (o->dilation_columns() != 1 || o->dilation_rows() != 1)
    return fail("dilated convolutions are not known here");
  node.kernel_rows = kernel[1];
  node.kernel_columns = kernel[2];
  node.stride_columns = o->stride_columns();
  node.stride_rows = o->stride_rows();
  int rows = 0, columns = 0;
  for (auto done : {place_window(from[1], kernel[1], node.stride_rows, o->padding(), node.pad_top,
                                 node.pad_bottom, rows),
                    place_window(from[2], kernel[2], node.stride_columns, o->padding(),
                                 node.pad_left, node.pad_right, columns),
                    set_activation(node, o->activation()), load(node.weights, Shape(kernel)),
                    load(node.bias, {channels})})
    if (!done) return done;
  return push(std::move(node), op, 1, {1, rows, columns, channels});
}

Result<void> TfliteReader::take_pool(const Operator& op) {
  const Shape& from = shape(op.inputs[0]);
  if (from.size() != 4 || from[0] != 1) return fail("it pools what is no picture");
  const auto* o = op.table->options_as_PoolOptions();
  if (!o) return fail(kNoOptions);
  GraphNode node;
  node.op = GraphOp::kMaxPool;
  node.stride_columns = o->stride_columns();
  node.stride_rows = o->stride_rows();
  node.kernel_columns = o->kernel_columns();
  node.kernel_rows = o->kernel_rows();
  int rows = 0, columns = 0;
  for (auto done : {place_window(from[1], node.kernel_rows, node.stride_rows, o->padding(),
                                 node.pad_top, node.pad_bottom, rows),
                    place_window(from[2], node.kernel_columns, node.stride_columns, o->padding(),
                                 node.pad_left, node.pad_right, columns),
                    set_activation(node, o->activation())})
    if (!done) return done;
  // What stands beyond the border would have to count as the least of all numbers.
  if (node.pad_top + node.pad_bottom + node.pad_left + node.pad_right > 0)
    return fail("pooling beyond the border is not known here");
  return push(std::move(node), op, 1, {1, rows, columns, from[3]});
}

Result<void> TfliteReader::take_add(const Operator& op) {
  if (op.inputs.size() != 2 || shape(op.inputs[0]) != shape(op.inputs[1]))
    return fail("what it adds is not of one shape");
  const auto* o = op.table->options_as_AddOptions();
  if (!o) return fail(kNoOptions);
  GraphNode node;
  node.op = GraphOp::kAdd;
  if (auto done = set_activation(node, o->activation()); !done) return done;
  return push(std::move(node), op, 2, shape(op.inputs[0]));
}

Result<void> TfliteReader::take_pad(const Operator& op) {
  Shape due = shape(op.inputs[0]);
  if (op.inputs.size() != 2 || due.size() != 4) return fail("it pads what is no picture");
  DANCE_TRY(const std::vector<int> amounts, tensors_->integers(op.inputs[1]));
  if (amounts.size() != 8) return fail("it does not say how far it pads");
  GraphNode node;
  node.op = GraphOp::kPad;
  for (std::size_t d = 0; d < 4; ++d) {
    const int before = amounts[2 * d], after = amounts[2 * d + 1];
    if (before < 0 || after < 0 || before > 4096 || after > 4096)
      return fail("it pads by " + std::to_string(before) + " and " + std::to_string(after));
    node.pad_before[d] = before;
    node.pad_after[d] = after;
    due[d] += before + after;
  }
  return push(std::move(node), op, 1, due);
}

Result<void> TfliteReader::take_resize(const Operator& op) {
  const Shape& from = shape(op.inputs[0]);
  if (op.inputs.size() != 2 || from.size() != 4) return fail("it resizes what is no picture");
  DANCE_TRY(const std::vector<int> size, tensors_->integers(op.inputs[1]));
  if (size.size() != 2) return fail("it does not say to which size");
  const auto* o = op.table->options_as_ResizeBilinearOptions();
  if (!o || o->align_corners() || !o->half_pixel_centers())
    return fail("it does not resize about the centres of pixels");
  GraphNode node;
  node.op = GraphOp::kResizeBilinear;
  return push(std::move(node), op, 1, {from[0], size[0], size[1], from[3]});
}

Result<void> TfliteReader::take_concatenation(const Operator& op) {
  const auto* o = op.table->options_as_ConcatenationOptions();
  if (!o) return fail(kNoOptions);
  Shape due = shape(op.inputs[0]);
  const int rank = static_cast<int>(due.size());
  GraphNode node;
  node.op = GraphOp::kConcatenate;
  node.axis = o->axis();
  if (node.axis < 0) node.axis += rank;
  if (node.axis < 0 || node.axis >= rank || o->activation() != kNoActivation)
    return fail("it joins along a dimension that is not there");
  const auto axis = static_cast<std::size_t>(node.axis);
  for (std::size_t d = 0; d < axis; ++d)
    if (due[d] != 1) return fail("it joins what does not lie behind each other");
  due[axis] = 0;
  for (const int input : op.inputs) {
    Shape rest = shape(input);
    if (rest.size() != due.size()) return fail("it joins what does not fit");
    due[axis] += rest[axis];
    rest[axis] = due[axis];
    if (rest != due) return fail("it joins what does not fit");
  }
  return push(std::move(node), op, op.inputs.size(), due);
}

Result<void> TfliteReader::take_depth_to_space(const Operator& op) {
  const auto* o = op.table->options_as_DepthToSpaceOptions();
  if (!o) return fail(kNoOptions);
  const Shape& from = shape(op.inputs[0]);
  GraphNode node;
  node.op = GraphOp::kDepthToSpace;
  node.block = o->block();
  if (from.size() != 4 || node.block < 2 || node.block > 8 ||
      from[3] % (node.block * node.block) != 0)
    return fail("its channels do not make blocks of " + std::to_string(node.block));
  return push(
      std::move(node), op, 1,
      {from[0], from[1] * node.block, from[2] * node.block, from[3] / (node.block * node.block)});
}

Result<void> TfliteReader::take_plain(const Operator& op, GraphOp kind) {
  GraphNode node;
  node.op = kind;
  if (kind == GraphOp::kClamp) node.least = 0.0f;
  const Shape& from = shape(op.inputs[0]);
  const Shape& to = shape(op.output);
  if (kind == GraphOp::kReshape && (to.empty() || elements_of(from) != elements_of(to)))
    return fail("it makes another number of elements");
  return push(std::move(node), op, 1, kind == GraphOp::kReshape ? to : from);
}

}  // namespace dance
