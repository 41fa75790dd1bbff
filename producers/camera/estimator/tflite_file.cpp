#include "producers/camera/estimator/tflite_file.h"

#include <algorithm>

#include "core/program/whole_file.h"
#include "producers/camera/estimator/tflite_reader.h"

namespace dance {
namespace {

constexpr std::size_t kMostFile_bytes = 64u << 20;
constexpr std::size_t kMostNodes = 2048;
constexpr std::size_t kMostInputs = 16;
constexpr std::uint32_t kSchemaVersion = 3;
// The tables that a file may have, before which its verification ends.
constexpr std::uint32_t kMostTables = 1u << 16;

}  // namespace

Result<PoseGraph> TfliteReader::read() {
  if (model_.subgraphs()->size() != 1) return fail("it has not one graph");
  const tflite::Subgraph& subgraph = *model_.subgraphs()->Get(0);
  DANCE_TRY(tensors_, TfliteTensors::read(model_, subgraph));
  for (std::size_t t = 0; t < tensors_->count(); ++t) {
    const int tensor = static_cast<int>(t);
    graph_.tensors.push_back({tensors_->name(tensor), tensors_->shape(tensor), {}});
  }
  is_computed_.assign(tensors_->count(), false);
  if (subgraph.inputs()->size() == 1) graph_.input = subgraph.inputs()->Get(0);
  if (!tensors_->has(graph_.input) || tensors_->is_constant(graph_.input) ||
      shape(graph_.input).size() != 4)
    return fail("it has not one picture as its input");
  is_computed_[static_cast<std::size_t>(graph_.input)] = true;
  const auto& operators = *subgraph.operators();
  if (operators.size() == 0 || operators.size() > kMostNodes)
    return fail("it has " + std::to_string(operators.size()) + " operators, where 1 to " +
                std::to_string(kMostNodes) + " are read");
  for (std::uint32_t i = 0; i < operators.size(); ++i) {
    if (auto done = read_operator(*operators.Get(i)); !done)
      return fail("operator " + std::to_string(i) + ": " + done.error().what);
  }
  const auto& outputs = *subgraph.outputs();
  if (outputs.size() == 0 || outputs.size() > kMostInputs) return fail("it has no outputs");
  for (const std::int32_t output : outputs) {
    if (!tensors_->has(output) || !is_computed_[static_cast<std::size_t>(output)] ||
        output == graph_.input)
      return fail("output " + std::to_string(graph_.outputs.size()) + " is not computed");
    graph_.outputs.push_back(output);
  }
  return std::move(graph_);
}

Result<void> TfliteReader::read_operator(const tflite::Operator& table) {
  if (table.code() >= model_.operator_codes()->size()) return fail("its kind is not in the file");
  const tflite::OperatorCode& code = *model_.operator_codes()->Get(table.code());
  const auto& inputs = *table.inputs();
  if (inputs.size() == 0 || inputs.size() > kMostInputs || table.outputs()->size() != 1)
    return fail("it has " + std::to_string(inputs.size()) + " inputs and " +
                std::to_string(table.outputs()->size()) + " outputs");
  const Operator op{&table, {inputs.begin(), inputs.end()}, table.outputs()->Get(0)};
  for (const int input : op.inputs)
    if (!tensors_->has(input)) return fail("it reads a tensor that is not there");
  if (!tensors_->has(op.output) || is_computed_[static_cast<std::size_t>(op.output)] ||
      tensors_->is_constant(op.output))
    return fail("it writes what has numbers already");
  return take(static_cast<TfliteBuiltin>(std::max<int>(code.old_builtin(), code.builtin())), op);
}

Result<PoseGraph> parse_tflite(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kMostFile_bytes) return fail("it is larger than 64 MiB");
  flatbuffers::Verifier::Options limits;
  limits.max_tables = kMostTables;
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), limits);
  if (!tflite::VerifyModelBuffer(verifier) ||
      tflite::GetModel(bytes.data())->version() != kSchemaVersion)
    return fail("it is no TensorFlow Lite file of version 3, or it is damaged");
  return TfliteReader(*tflite::GetModel(bytes.data())).read();
}

Result<PoseGraph> read_tflite_file(const std::string& path) {
  auto file = read_whole_file(path, kMostFile_bytes);
  if (!file) return fail(file.error().what + "; `dance fetch-models` fetches it");
  auto graph = parse_tflite({reinterpret_cast<const std::uint8_t*>(file->data()), file->size()});
  if (!graph)
    return fail(path + ": " + graph.error().what + "; `dance fetch-models` fetches it anew");
  return graph;
}

}  // namespace dance
