#include "producers/camera/estimator/pose_graph.h"

#include <algorithm>

namespace dance {
namespace {

bool pads_only_rows_and_columns(const GraphNode& node) {
  return node.op == GraphOp::kPad && node.pad_before[0] == 0 && node.pad_after[0] == 0 &&
         node.pad_before[3] == 0 && node.pad_after[3] == 0;
}

bool is_convolution(const GraphNode& node) {
  return node.op == GraphOp::kConvolution || node.op == GraphOp::kDepthwise;
}

}  // namespace

void keep_outputs(PoseGraph& graph, const std::vector<int>& outputs) {
  graph.outputs = outputs;
  std::vector<bool> is_needed(graph.tensors.size(), false);
  for (const int t : outputs) is_needed[static_cast<std::size_t>(t)] = true;
  std::vector<GraphNode> kept;
  for (auto node = graph.nodes.rbegin(); node != graph.nodes.rend(); ++node) {
    if (!is_needed[static_cast<std::size_t>(node->output)]) continue;
    for (const int t : node->inputs) is_needed[static_cast<std::size_t>(t)] = true;
    for (const int t : {node->weights, node->bias})
      if (t >= 0) is_needed[static_cast<std::size_t>(t)] = true;
    kept.push_back(std::move(*node));
  }
  std::reverse(kept.begin(), kept.end());
  graph.nodes = std::move(kept);
  for (std::size_t t = 0; t < graph.tensors.size(); ++t)
    if (!is_needed[t]) graph.tensors[t].values = {};
}

void fold_pads(PoseGraph& graph) {
  for (const GraphNode& pad : graph.nodes) {
    if (!pads_only_rows_and_columns(pad)) continue;
    const auto reads_pad = [&](const GraphNode& node) {
      return std::find(node.inputs.begin(), node.inputs.end(), pad.output) != node.inputs.end();
    };
    const bool is_read_otherwise =
        std::find(graph.outputs.begin(), graph.outputs.end(), pad.output) != graph.outputs.end() ||
        std::any_of(graph.nodes.begin(), graph.nodes.end(), [&](const GraphNode& node) {
          return reads_pad(node) && !is_convolution(node);
        });
    if (is_read_otherwise) continue;
    for (GraphNode& node : graph.nodes) {
      if (!reads_pad(node)) continue;
      node.inputs[0] = pad.inputs[0];
      node.pad_top += pad.pad_before[1];
      node.pad_bottom += pad.pad_after[1];
      node.pad_left += pad.pad_before[2];
      node.pad_right += pad.pad_after[2];
    }
  }
  keep_outputs(graph, graph.outputs);
}

}  // namespace dance
