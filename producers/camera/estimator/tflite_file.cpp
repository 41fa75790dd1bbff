#include "producers/camera/estimator/tflite_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "producers/camera/estimator/tflite_reader.h"

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
}  // namespace

Result<PoseGraph> TfliteReader::read() {
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

Result<void> TfliteReader::read_operators(const FlatTable& model, const FlatTable& subgraph) {
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

Result<void> TfliteReader::read_operator(const FlatTable& table, const FlatVector& codes,
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
  return take(static_cast<TfliteBuiltin>(std::max<int>(code.u8(kCodeOld), code.i32(kCodeNew))), op);
}

Result<PoseGraph> parse_tflite(std::span<const std::uint8_t> bytes) {
  return TfliteReader(bytes).read();
}

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
  if (!graph) return fail(path + ": " + graph.error().what + "; ./dance setup fetches it again");
  return graph;
}

}  // namespace dance
