// PoseEngine with XNNPACK, on the caller's thread.
#include <xnnpack.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "producers/camera/estimator/pose_engine.h"

namespace dance {
namespace {

constexpr std::size_t kSlack = XNN_EXTRA_BYTES / sizeof(float);

// XNNPACK since 2024 defines these five operators by xnn_define_unary, _binary and _static_reduce,
// and has deprecated what Debian 12 has.
#if DANCE_XNNPACK_HAS_UNARY
xnn_status define_add(xnn_subgraph* g, float least, float most, std::uint32_t a, std::uint32_t b,
                      std::uint32_t out) {
  const xnn_binary_params range{least, most};
  return xnn_define_binary(g, xnn_binary_add, &range, a, b, out, 0);
}
xnn_status define_sigmoid(xnn_subgraph* g, std::uint32_t in, std::uint32_t out) {
  return xnn_define_unary(g, xnn_unary_sigmoid, nullptr, in, out, 0);
}
xnn_status define_clamp(xnn_subgraph* g, float least, float most, std::uint32_t in,
                        std::uint32_t out) {
  xnn_unary_params range{};
  range.clamp = {least, most};
  return xnn_define_unary(g, xnn_unary_clamp, &range, in, out, 0);
}
xnn_status define_prelu(xnn_subgraph* g, std::uint32_t in, std::uint32_t slopes,
                        std::uint32_t out) {
  return xnn_define_binary(g, xnn_binary_prelu, nullptr, in, slopes, out, 0);
}
// The mean over rows and columns. A mean has no range of its own here; it needs none where the
// network names none.
xnn_status define_mean(xnn_subgraph* g, float least, float most, std::uint32_t in,
                       std::uint32_t out) {
  if (std::isfinite(least) || std::isfinite(most)) return xnn_status_unsupported_parameter;
  constexpr std::array<std::size_t, 2> kRowsAndColumns{1, 2};
  return xnn_define_static_reduce(g, xnn_reduce_mean, kRowsAndColumns.size(),
                                  kRowsAndColumns.data(), in, out, XNN_FLAG_KEEP_DIMS);
}
#else
xnn_status define_add(xnn_subgraph* g, float least, float most, std::uint32_t a, std::uint32_t b,
                      std::uint32_t out) {
  return xnn_define_add2(g, least, most, a, b, out, 0);
}
xnn_status define_sigmoid(xnn_subgraph* g, std::uint32_t in, std::uint32_t out) {
  return xnn_define_sigmoid(g, in, out, 0);
}
xnn_status define_clamp(xnn_subgraph* g, float least, float most, std::uint32_t in,
                        std::uint32_t out) {
  return xnn_define_clamp(g, least, most, in, out, 0);
}
xnn_status define_prelu(xnn_subgraph* g, std::uint32_t in, std::uint32_t slopes,
                        std::uint32_t out) {
  return xnn_define_prelu(g, in, slopes, out, 0);
}
xnn_status define_mean(xnn_subgraph* g, float least, float most, std::uint32_t in,
                       std::uint32_t out) {
  return xnn_define_global_average_pooling_2d(g, least, most, in, out, 0);
}
#endif

struct FreeSubgraph {
  void operator()(xnn_subgraph* subgraph) const { xnn_delete_subgraph(subgraph); }
};
struct FreeRuntime {
  void operator()(xnn_runtime* runtime) const { xnn_delete_runtime(runtime); }
};

class XnnpackEngine final : public PoseEngine {
 public:
  Result<void> build(const PoseGraph& graph);

  std::span<float> input() override { return {input_.data(), input_.size() - kSlack}; }
  bool run() override { return xnn_invoke_runtime(runtime_.get()) == xnn_status_success; }
  std::span<const float> output(std::size_t i) const override {
    return {outputs_[i].data(), outputs_[i].size() - kSlack};
  }

 private:
  void plan_outputs(const PoseGraph& graph);
  xnn_status define_tensors(const PoseGraph& graph);
  xnn_status define(const PoseGraph& graph, const GraphNode& node);
  std::uint32_t id(int tensor) const { return ids_[static_cast<std::size_t>(tensor)]; }

  std::unique_ptr<xnn_subgraph, FreeSubgraph> subgraph_;
  std::unique_ptr<xnn_runtime, FreeRuntime> runtime_;
  std::vector<std::vector<float>> constants_;
  // The runtime points into these.
  std::vector<float> input_;
  std::vector<std::vector<float>> outputs_;
  std::vector<std::uint32_t> ids_;
  // Where tensors go that leave the network. XNNPACK of Debian 12 cannot join: the parts are
  // written behind each other instead.
  std::map<int, float*> leaving_;
};

void XnnpackEngine::plan_outputs(const PoseGraph& graph) {
  for (const int output : graph.outputs) {
    outputs_.emplace_back(elements_of(graph.shape(output)) + kSlack);
    leaving_[output] = outputs_.back().data();
  }
  for (auto node = graph.nodes.rbegin(); node != graph.nodes.rend(); ++node) {
    if (node->op != GraphOp::kConcatenate) continue;
    float* at = leaving_.count(node->output) ? leaving_[node->output] : nullptr;
    leaving_.erase(node->output);
    for (const int part : node->inputs) {
      leaving_[part] = at;
      if (at) at += elements_of(graph.shape(part));
    }
  }
}

xnn_status XnnpackEngine::define_tensors(const PoseGraph& graph) {
  ids_.assign(graph.tensors.size(), XNN_INVALID_VALUE_ID);
  std::uint32_t external = 1;
  std::vector<bool> is_used(graph.tensors.size(), false);
  for (const GraphNode& node : graph.nodes) {
    if (node.op == GraphOp::kConcatenate) continue;
    for (const int t : node.inputs) is_used[static_cast<std::size_t>(t)] = true;
    for (const int t : {node.weights, node.bias, node.output})
      if (t >= 0) is_used[static_cast<std::size_t>(t)] = true;
  }
  for (std::size_t t = 0; t < graph.tensors.size(); ++t) {
    if (!is_used[t]) continue;
    const int tensor = static_cast<int>(t);
    const std::vector<std::size_t> dims(graph.shape(tensor).begin(), graph.shape(tensor).end());
    const float* data = nullptr;
    std::uint32_t flags = 0, external_id = XNN_INVALID_VALUE_ID;
    if (!graph.values(tensor).empty()) {
      constants_.push_back(graph.values(tensor));
      constants_.back().resize(constants_.back().size() + kSlack);
      data = constants_.back().data();
    } else if (tensor == graph.input) {
      external_id = 0;
      flags = XNN_VALUE_FLAG_EXTERNAL_INPUT;
    } else if (leaving_.count(tensor)) {
      external_id = external++;
      flags = XNN_VALUE_FLAG_EXTERNAL_OUTPUT;
    }
    const xnn_status status =
        xnn_define_tensor_value(subgraph_.get(), xnn_datatype_fp32, dims.size(), dims.data(), data,
                                external_id, flags, &ids_[t]);
    if (status != xnn_status_success) return status;
  }
  return xnn_status_success;
}

xnn_status XnnpackEngine::define(const PoseGraph& graph, const GraphNode& n) {
  xnn_subgraph* const g = subgraph_.get();
  const auto u = [](int value) { return static_cast<std::uint32_t>(value); };
  const auto z = [](int value) { return static_cast<std::size_t>(value); };
  const std::uint32_t in = n.inputs.empty() ? XNN_INVALID_VALUE_ID : id(n.inputs[0]);
  const std::uint32_t out = id(n.output);
  const Shape& from = graph.shape(n.inputs[0]);
  const Shape& to = graph.shape(n.output);
  switch (n.op) {
    case GraphOp::kConvolution:
      return xnn_define_convolution_2d(
          g, u(n.pad_top), u(n.pad_right), u(n.pad_bottom), u(n.pad_left), u(n.kernel_rows),
          u(n.kernel_columns), u(n.stride_rows), u(n.stride_columns), 1, 1, 1, z(from[3]), z(to[3]),
          n.least, n.most, in, id(n.weights), id(n.bias), out, 0);
    case GraphOp::kDepthwise:
      return xnn_define_depthwise_convolution_2d(
          g, u(n.pad_top), u(n.pad_right), u(n.pad_bottom), u(n.pad_left), u(n.kernel_rows),
          u(n.kernel_columns), u(n.stride_rows), u(n.stride_columns), 1, 1, 1, z(from[3]), n.least,
          n.most, in, id(n.weights), id(n.bias), out, 0);
    case GraphOp::kAdd:
      return define_add(g, n.least, n.most, in, id(n.inputs[1]), out);
    case GraphOp::kPad: {
      const std::vector<std::size_t> before(n.pad_before.begin(), n.pad_before.end());
      const std::vector<std::size_t> after(n.pad_after.begin(), n.pad_after.end());
      return xnn_define_static_constant_pad(g, before.data(), after.data(), 0.0f, in, out, 0);
    }
    case GraphOp::kMaxPool:
      return xnn_define_max_pooling_2d(g, 0, 0, 0, 0, u(n.kernel_rows), u(n.kernel_columns),
                                       u(n.stride_rows), u(n.stride_columns), 1, 1, n.least, n.most,
                                       in, out, 0);
    case GraphOp::kResizeBilinear:
      return xnn_define_static_resize_bilinear_2d(g, z(to[1]), z(to[2]), in, out, 0);
    case GraphOp::kReshape: {
      const std::vector<std::size_t> dims(to.begin(), to.end());
      return xnn_define_static_reshape(g, dims.size(), dims.data(), in, out, 0);
    }
    case GraphOp::kLogistic:
      return define_sigmoid(g, in, out);
    case GraphOp::kDepthToSpace:
      return xnn_define_depth_to_space(g, in, out, u(n.block), 0);
    case GraphOp::kClamp:
      return define_clamp(g, n.least, n.most, in, out);
    case GraphOp::kPrelu:
      return define_prelu(g, in, id(n.weights), out);
    case GraphOp::kMean:
      return define_mean(g, n.least, n.most, in, out);
    case GraphOp::kFullyConnected:
      return xnn_define_fully_connected(g, n.least, n.most, in, id(n.weights), id(n.bias), out, 0);
    case GraphOp::kConcatenate:
      return xnn_status_success;
  }
  return xnn_status_unsupported_parameter;
}

Result<void> XnnpackEngine::build(const PoseGraph& graph) {
  const auto refused = [](const std::string& what) {
    return fail("XNNPACK refuses " + what + "; take the engine opencv");
  };
  if (xnn_initialize(nullptr) != xnn_status_success) return refused("this processor");
  plan_outputs(graph);
  xnn_subgraph_t subgraph = nullptr;
  if (xnn_create_subgraph(static_cast<std::uint32_t>(leaving_.size() + 1), 0, &subgraph) !=
      xnn_status_success)
    return refused("a new network");
  subgraph_.reset(subgraph);
  constants_.reserve(graph.tensors.size());
  if (define_tensors(graph) != xnn_status_success) return refused("a tensor of this network");
  for (const GraphNode& node : graph.nodes)
    if (define(graph, node) != xnn_status_success)
      return refused("what makes '" + graph.tensors[static_cast<std::size_t>(node.output)].name +
                     "' of this network");
  xnn_runtime_t runtime = nullptr;
  if (xnn_create_runtime_v2(subgraph_.get(), nullptr, 0, &runtime) != xnn_status_success)
    return refused("to run this network");
  runtime_.reset(runtime);
  input_.assign(elements_of(graph.shape(graph.input)) + kSlack, 0.0f);
  std::vector<xnn_external_value> external{{id(graph.input), input_.data()}};
  for (const auto& [tensor, at] : leaving_) {
    if (!at) return refused("to join what is read again");
    external.push_back({id(tensor), at});
  }
  if (xnn_setup_runtime(runtime, external.size(), external.data()) != xnn_status_success)
    return refused("the memory of this network");
  // The constants stay: convolutions have copies of their weights, but other operators, for example
  // PReLU since 2024, read them in place.
  subgraph_.reset();
  return {};
}

}  // namespace

Result<std::unique_ptr<PoseEngine>> make_xnnpack_engine(const PoseGraph& graph) {
  auto engine = std::make_unique<XnnpackEngine>();
  if (auto built = engine->build(graph); !built) return tl::make_unexpected(built.error());
  return engine;
}

}  // namespace dance
