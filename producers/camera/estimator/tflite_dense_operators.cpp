// The operations of a .tflite file that hand and face networks have beside those of the pose: what
// is learned for each channel, and what mixes all numbers.
#include "producers/camera/estimator/tflite_reader.h"

namespace dance {

int TfliteReader::add_constant(const char* name, Shape shape, std::vector<float> values) {
  graph_.tensors.push_back({name, std::move(shape), std::move(values)});
  return static_cast<int>(graph_.tensors.size()) - 1;
}

Result<void> TfliteReader::take_prelu(const Operator& op) {
  const Shape& from = shape(op.inputs[0]);
  if (op.inputs.size() != 2 || from.size() != 4) return fail("it has no weights, or no picture");
  GraphNode node;
  node.op = GraphOp::kPrelu;
  node.weights = op.inputs[1];
  // One for each channel, whichever place is.
  if (auto done = load(node.weights, {1, 1, from[3]}); !done) return done;
  graph_.tensors[static_cast<std::size_t>(node.weights)].shape = {from[3]};
  return push(std::move(node), op, 1, Shape(from));
}

Result<void> TfliteReader::take_mean(const Operator& op) {
  const auto* o = op.table->options_as_MeanOptions();
  if (!o) return fail("it has no options of its kind");
  const Shape& from = shape(op.inputs[0]);
  if (op.inputs.size() != 2 || from.size() != 4 || from[0] != 1)
    return fail("it takes the mean of what is no picture");
  DANCE_TRY(const std::vector<int> axes, tensors_->integers(op.inputs[1]));
  if (axes != std::vector<int>{1, 2} || o->keeps_dimensions())
    return fail("it takes another mean than that of each channel");
  GraphNode node;
  node.op = GraphOp::kMean;
  return push(std::move(node), op, 1, {1, from[3]});
}

Result<void> TfliteReader::take_fully_connected(const Operator& op) {
  const auto* o = op.table->options_as_FullyConnectedOptions();
  if (!o) return fail("it has no options of its kind");
  if (op.inputs.size() != 3) return fail("a fully connected layer has weights and a bias");
  GraphNode node;
  node.op = GraphOp::kFullyConnected;
  node.weights = op.inputs[1];
  node.bias = op.inputs[2];
  const Shape& from = shape(op.inputs[0]);
  const Shape& weights = shape(node.weights);
  if (from.size() != 2 || from[0] != 1 || weights.size() != 2 || weights[1] != from[1] ||
      o->weights_format() != 0)
    return fail("its weights do not fit its input");
  const int numbers = weights[0];
  for (auto done : {set_activation(node, o->activation()), load(node.weights, Shape(weights)),
                    load(node.bias, {numbers})})
    if (!done) return done;
  return push(std::move(node), op, 1, {1, numbers});
}

// The first channels of a picture, which is all that these networks slice, as a convolution that
// copies them: both engines have that, and their numbers are the same.
Result<void> TfliteReader::take_first_channels(const Operator& op) {
  const auto* o = op.table->options_as_StridedSliceOptions();
  if (!o) return fail("it has no options of its kind");
  const Shape from = shape(op.inputs[0]);
  if (op.inputs.size() != 4 || from.size() != 4 || from[0] != 1)
    return fail("it slices what is no picture");
  DANCE_TRY(const std::vector<int> begin, tensors_->integers(op.inputs[1]));
  DANCE_TRY(std::vector<int> end, tensors_->integers(op.inputs[2]));
  DANCE_TRY(const std::vector<int> steps, tensors_->integers(op.inputs[3]));
  const bool is_masked = (o->end_mask() & ~7) != 0 || o->ellipsis_mask() != 0 ||
                         o->new_axis_mask() != 0 || o->shrink_axis_mask() != 0;
  if (end.size() != 4 || begin != std::vector<int>(4, 0) || steps != std::vector<int>(4, 1) ||
      is_masked)
    return fail("it takes other parts than the first channels");
  for (std::size_t d = 0; d < 3; ++d)
    if ((o->end_mask() >> d & 1) != 0) end[d] = from[d];
  const int channels = end[3];
  constexpr int kMostChannels = 64;
  if (end[0] != from[0] || end[1] != from[1] || end[2] != from[2] || channels < 1 ||
      channels > from[3] || from[3] > kMostChannels)
    return fail("it takes other parts than the first channels");
  const auto in = static_cast<std::size_t>(from[3]), out = static_cast<std::size_t>(channels);
  std::vector<float> copying(in * out, 0.0f);
  for (std::size_t c = 0; c < out; ++c) copying[c * in + c] = 1.0f;
  GraphNode node;
  node.op = GraphOp::kConvolution;
  node.weights = add_constant("copying", {channels, 1, 1, from[3]}, std::move(copying));
  node.bias = add_constant("nothing", {channels}, std::vector<float>(out, 0.0f));
  return push(std::move(node), op, 1, {1, from[1], from[2], channels});
}

}  // namespace dance
