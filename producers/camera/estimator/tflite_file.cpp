#include "producers/camera/estimator/tflite_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>

#include "producers/camera/estimator/flat_bytes.h"
#include "producers/camera/estimator/tflite_tensors.h"

namespace dance {
namespace {

constexpr std::size_t kMostFile_bytes = 64u << 20;
constexpr std::size_t kMostNodes = 2048;
constexpr std::size_t kMostInputs = 16;
constexpr std::int32_t kSchemaVersion = 3;
// Fields of the schema's tables.
constexpr std::size_t kModelVersion = 0, kModelCodes = 1, kModelSubgraphs = 2;
constexpr std::size_t kSubgraphInputs = 1, kSubgraphOutputs = 2, kSubgraphOperators = 3;
constexpr std::size_t kCodeOld = 0, kCodeNew = 3;
constexpr std::size_t kOperatorCode = 0, kOperatorInputs = 1, kOperatorOutputs = 2,
                      kOperatorOptions = 4;
// The schema's numbers of the operations.
enum class Builtin {
  kAdd = 0,
  kConcatenation = 2,
  kConv2d = 3,
  kDepthwiseConv2d = 4,
  kDepthToSpace = 5,
  kDequantize = 6,
  kLogistic = 14,
  kMaxPool2d = 17,
  kReshape = 22,
  kResizeBilinear = 23,
  kPad = 34,
  kDensify = 124,
};
constexpr int kSame = 0, kValid = 1;
constexpr int kNoActivation = 0, kRelu = 1, kRelu6 = 3;

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : file_(bytes) {}
  Result<PoseGraph> read();

 private:
  struct Operator {
    FlatTable options;
    std::vector<int> inputs;
    int output = -1;
  };
  using Done = Result<void>;

  Done read_operators(const FlatTable& model, const FlatTable& subgraph);
  Done read_operator(const FlatTable& table, const FlatVector& codes, const FlatTable& model);
  Done take(Builtin builtin, Operator& op);
  Done take_same(const Operator& op);
  Done take_convolution(Operator& op, bool is_depthwise);
  Done take_pool(const Operator& op);
  Done take_add(const Operator& op);
  Done take_pad(const Operator& op);
  Done take_resize(const Operator& op);
  Done take_concatenation(const Operator& op);
  Done take_depth_to_space(const Operator& op);
  Done take_plain(const Operator& op, GraphOp kind);

  Done set_activation(GraphNode& node, int activation) const;
  // Where the window of kernel and stride goes over rows or columns: what is added before and after them, and how often it fits.
  static Done place_window(int size, int kernel, int stride, int padding, int& before, int& after,
                           int& places);
  Done load(int tensor, const Shape& shape);
  Done push(GraphNode node, const Operator& op, std::size_t data_inputs, const Shape& shape);
  const Shape& shape(int tensor) const { return tensors_->shape(tensor); }

  FlatBytes file_;
  std::optional<TfliteTensors> tensors_;
  std::vector<bool> is_computed_;
  PoseGraph graph_;
};

Result<PoseGraph> Reader::read() {
  const FlatTable model = FlatTable::root(file_);
  if (!model.is_there() || model.i32(kModelVersion) != kSchemaVersion)
    return fail("it is no TensorFlow Lite file of version 3");
  const FlatVector subgraphs = model.vector(kModelSubgraphs, 4);
  if (subgraphs.count != 1) return fail("it has not one graph");
  const FlatTable subgraph = model.table_of(subgraphs, 0);
  DANCE_TRY(tensors_, TfliteTensors::read(file_, model, subgraph));
  for (std::size_t t = 0; t < tensors_->count(); ++t) {
    const int tensor = static_cast<int>(t);
    graph_.tensors.push_back({tensors_->name(tensor), tensors_->shape(tensor), {}});
  }
  is_computed_.assign(tensors_->count(), false);
  const FlatVector inputs = subgraph.vector(kSubgraphInputs, 4);
  graph_.input = inputs.i32(0);
  if (inputs.count != 1 || !tensors_->has(graph_.input) || tensors_->is_constant(graph_.input) ||
      shape(graph_.input).size() != 4)
    return fail("it has not one picture as its input");
  is_computed_[static_cast<std::size_t>(graph_.input)] = true;
  if (auto done = read_operators(model, subgraph); !done) return tl::make_unexpected(done.error());
  const FlatVector outputs = subgraph.vector(kSubgraphOutputs, 4);
  if (outputs.count == 0 || outputs.count > kMostInputs) return fail("it has no outputs");
  for (std::size_t i = 0; i < outputs.count; ++i) {
    const std::int32_t output = outputs.i32(i);
    if (!tensors_->has(output) || !is_computed_[static_cast<std::size_t>(output)] ||
        output == graph_.input)
      return fail("output " + std::to_string(i) + " is not computed");
    graph_.outputs.push_back(output);
  }
  if (!file_.ok()) return fail("it points out of itself");
  return std::move(graph_);
}

Result<void> Reader::read_operators(const FlatTable& model, const FlatTable& subgraph) {
  const FlatVector codes = model.vector(kModelCodes, 4);
  const FlatVector operators = subgraph.vector(kSubgraphOperators, 4);
  if (operators.count == 0 || operators.count > kMostNodes)
    return fail("it has " + std::to_string(operators.count) + " operators, where 1 to " +
                std::to_string(kMostNodes) + " are read");
  for (std::size_t i = 0; i < operators.count; ++i) {
    const std::string which = "operator " + std::to_string(i) + ": ";
    auto done = read_operator(subgraph.table_of(operators, i), codes, model);
    if (!done) return fail(which + done.error().what);
    if (!file_.ok()) return fail(which + "it points out of the file");
  }
  return {};
}

Result<void> Reader::read_operator(const FlatTable& table, const FlatVector& codes,
                                   const FlatTable& model) {
  const FlatTable code = model.table_of(codes, table.u32(kOperatorCode));
  if (!code.is_there()) return fail("its kind is not in the file");
  const FlatVector inputs = table.vector(kOperatorInputs, 4);
  const FlatVector outputs = table.vector(kOperatorOutputs, 4);
  if (inputs.count == 0 || inputs.count > kMostInputs || outputs.count != 1)
    return fail("it has " + std::to_string(inputs.count) + " inputs and " +
                std::to_string(outputs.count) + " outputs");
  Operator op;
  op.options = table.table(kOperatorOptions);
  op.output = outputs.i32(0);
  for (std::size_t i = 0; i < inputs.count; ++i) {
    op.inputs.push_back(inputs.i32(i));
    if (!tensors_->has(op.inputs.back())) return fail("it reads a tensor that is not there");
  }
  if (!tensors_->has(op.output) || is_computed_[static_cast<std::size_t>(op.output)] ||
      tensors_->is_constant(op.output))
    return fail("it writes what has numbers already");
  return take(static_cast<Builtin>(std::max<int>(code.u8(kCodeOld), code.i32(kCodeNew))), op);
}

Result<void> Reader::take(Builtin builtin, Operator& op) {
  switch (builtin) {
    case Builtin::kDequantize:
    case Builtin::kDensify:
      return take_same(op);
    case Builtin::kConv2d:
      return take_convolution(op, false);
    case Builtin::kDepthwiseConv2d:
      return take_convolution(op, true);
    case Builtin::kMaxPool2d:
      return take_pool(op);
    case Builtin::kAdd:
      return take_add(op);
    case Builtin::kPad:
      return take_pad(op);
    case Builtin::kResizeBilinear:
      return take_resize(op);
    case Builtin::kConcatenation:
      return take_concatenation(op);
    case Builtin::kDepthToSpace:
      return take_depth_to_space(op);
    case Builtin::kReshape:
      return take_plain(op, GraphOp::kReshape);
    case Builtin::kLogistic:
      return take_plain(op, GraphOp::kLogistic);
  }
  return fail("operation " + std::to_string(static_cast<int>(builtin)) + " is not known here");
}

Result<void> Reader::take_same(const Operator& op) {
  if (!tensors_->is_constant(op.inputs[0])) return fail("what it unpacks is no constant");
  tensors_->set_same(op.inputs[0], op.output);
  return {};
}

Result<void> Reader::set_activation(GraphNode& node, int activation) const {
  if (activation == kNoActivation) return {};
  if (activation != kRelu && activation != kRelu6)
    return fail("activation " + std::to_string(activation) + " is not known here");
  node.least = 0.0f;
  if (activation == kRelu6) node.most = 6.0f;
  return {};
}

Result<void> Reader::place_window(int size, int kernel, int stride, int padding, int& before,
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

Result<void> Reader::load(int tensor, const Shape& due) {
  if (!tensors_->is_constant(tensor)) return fail("its weights are no constants");
  if (shape(tensor) != due) return fail("its weights are not of the due shape");
  auto& values = graph_.tensors[static_cast<std::size_t>(tensor)].values;
  if (values.empty()) {
    DANCE_TRY(values, tensors_->floats(tensor));
  }
  return {};
}

Result<void> Reader::push(GraphNode node, const Operator& op, std::size_t data_inputs,
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

Result<void> Reader::take_convolution(Operator& op, bool is_depthwise) {
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
  const FlatTable& o = op.options;
  // Between the strides and the rest stands, of a depthwise one, the multiplier of channels.
  const std::size_t shift = is_depthwise ? 1 : 0;
  if (o.i32(4 + shift, 1) != 1 || o.i32(5 + shift, 1) != 1)
    return fail("dilated convolutions are not known here");
  node.kernel_rows = kernel[1];
  node.kernel_columns = kernel[2];
  node.stride_columns = o.i32(1);
  node.stride_rows = o.i32(2);
  int rows = 0, columns = 0;
  for (auto done : {place_window(from[1], kernel[1], node.stride_rows, o.u8(0), node.pad_top,
                                 node.pad_bottom, rows),
                    place_window(from[2], kernel[2], node.stride_columns, o.u8(0), node.pad_left,
                                 node.pad_right, columns),
                    set_activation(node, o.u8(3 + shift)), load(node.weights, Shape(kernel)),
                    load(node.bias, {channels})})
    if (!done) return done;
  return push(std::move(node), op, 1, {1, rows, columns, channels});
}

Result<void> Reader::take_pool(const Operator& op) {
  const Shape& from = shape(op.inputs[0]);
  if (from.size() != 4 || from[0] != 1) return fail("it pools what is no picture");
  const FlatTable& o = op.options;
  GraphNode node;
  node.op = GraphOp::kMaxPool;
  node.stride_columns = o.i32(1);
  node.stride_rows = o.i32(2);
  node.kernel_columns = o.i32(3);
  node.kernel_rows = o.i32(4);
  int rows = 0, columns = 0;
  for (auto done : {place_window(from[1], node.kernel_rows, node.stride_rows, o.u8(0), node.pad_top,
                                 node.pad_bottom, rows),
                    place_window(from[2], node.kernel_columns, node.stride_columns, o.u8(0),
                                 node.pad_left, node.pad_right, columns),
                    set_activation(node, o.u8(5))})
    if (!done) return done;
  // What stands beyond the border would have to count as the least of all numbers.
  if (node.pad_top + node.pad_bottom + node.pad_left + node.pad_right > 0)
    return fail("pooling beyond the border is not known here");
  return push(std::move(node), op, 1, {1, rows, columns, from[3]});
}

Result<void> Reader::take_add(const Operator& op) {
  if (op.inputs.size() != 2 || shape(op.inputs[0]) != shape(op.inputs[1]))
    return fail("what it adds is not of one shape");
  GraphNode node;
  node.op = GraphOp::kAdd;
  if (auto done = set_activation(node, op.options.u8(0)); !done) return done;
  return push(std::move(node), op, 2, shape(op.inputs[0]));
}

Result<void> Reader::take_pad(const Operator& op) {
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

Result<void> Reader::take_resize(const Operator& op) {
  const Shape& from = shape(op.inputs[0]);
  if (op.inputs.size() != 2 || from.size() != 4) return fail("it resizes what is no picture");
  DANCE_TRY(const std::vector<int> size, tensors_->integers(op.inputs[1]));
  if (size.size() != 2) return fail("it does not say to which size");
  constexpr std::size_t kAlignCorners = 2, kHalfPixelCenters = 3;
  if (op.options.u8(kAlignCorners) != 0 || op.options.u8(kHalfPixelCenters) != 1)
    return fail("it does not resize about the centres of pixels");
  GraphNode node;
  node.op = GraphOp::kResizeBilinear;
  return push(std::move(node), op, 1, {from[0], size[0], size[1], from[3]});
}

Result<void> Reader::take_concatenation(const Operator& op) {
  Shape due = shape(op.inputs[0]);
  const int rank = static_cast<int>(due.size());
  GraphNode node;
  node.op = GraphOp::kConcatenate;
  node.axis = op.options.i32(0);
  if (node.axis < 0) node.axis += rank;
  if (node.axis < 0 || node.axis >= rank || op.options.u8(1) != kNoActivation)
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

Result<void> Reader::take_depth_to_space(const Operator& op) {
  const Shape& from = shape(op.inputs[0]);
  GraphNode node;
  node.op = GraphOp::kDepthToSpace;
  node.block = op.options.i32(0);
  if (from.size() != 4 || node.block < 2 || node.block > 8 ||
      from[3] % (node.block * node.block) != 0)
    return fail("its channels do not make blocks of " + std::to_string(node.block));
  return push(
      std::move(node), op, 1,
      {from[0], from[1] * node.block, from[2] * node.block, from[3] / (node.block * node.block)});
}

Result<void> Reader::take_plain(const Operator& op, GraphOp kind) {
  GraphNode node;
  node.op = kind;
  const Shape& from = shape(op.inputs[0]);
  const Shape& to = shape(op.output);
  if (kind == GraphOp::kReshape && (to.empty() || elements_of(from) != elements_of(to)))
    return fail("it makes another number of elements");
  return push(std::move(node), op, 1, kind == GraphOp::kReshape ? to : from);
}

}  // namespace

Result<PoseGraph> parse_tflite(std::span<const std::uint8_t> bytes) { return Reader(bytes).read(); }

Result<PoseGraph> read_tflite_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail(path + ": cannot be opened; ./dance setup fetches it");
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  if (size < 0 || static_cast<std::size_t>(size) > kMostFile_bytes)
    return fail(path + ": is no file of at most 64 MiB");
  file.seekg(0);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  if (size > 0 && !file.read(reinterpret_cast<char*>(bytes.data()), size))
    return fail(path + ": cannot be read");
  auto graph = parse_tflite(bytes);
  if (!graph) return fail(path + ": " + graph.error().what + "; ./dance setup fetches it anew");
  return graph;
}

}  // namespace dance
