// PoseEngine with the dnn module of OpenCV, layer by layer. Inside, pictures lie channels first.
#include <algorithm>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>
#include <vector>

#include "producers/camera/estimator/pose_engine.h"

namespace dance {
namespace {

using cv::dnn::LayerParams;

bool is_picture(const Shape& shape) { return shape.size() == 4; }

class OpenCvEngine final : public PoseEngine {
 public:
  explicit OpenCvEngine(const PoseGraph& graph);

  std::span<float> input() override { return input_; }
  bool run() override;
  std::span<const float> output(std::size_t i) const override {
    return {results_[i].ptr<float>(), results_[i].total()};
  }

 private:
  // A layer, and the tensor that it makes: which lies as in the file, or, of pictures, channels
  // first.
  void add(LayerParams& layer, const char* type, const std::vector<int>& from);
  int made(int tensor) const { return made_.at(tensor); }
  void add_node(const PoseGraph& graph, const GraphNode& node);
  void add_convolution(const PoseGraph& graph, const GraphNode& node);
  int as_in_file(const PoseGraph& graph, int tensor);
  void permute(const std::string& name, const std::vector<int>& order, int from);
  void reshape(const std::string& name, const std::vector<int>& dims, int from);

  cv::dnn::Net net_;
  std::map<int, int> made_;  // tensor → layer
  std::vector<std::string> names_{"picture"};
  int last_ = 0;
  int serial_ = 0;
  int rows_ = 0, columns_ = 0, channels_ = 0;
  std::vector<float> input_;
  cv::Mat planes_;
  std::vector<cv::Mat> channel_headers_;
  std::vector<std::string> outputs_;
  std::vector<cv::Mat> results_;
};

void OpenCvEngine::add(LayerParams& layer, const char* type, const std::vector<int>& from) {
  layer.type = type;
  layer.name += "_" + std::to_string(serial_++);
  const int id = net_.addLayer(layer.name, type, layer);
  for (std::size_t i = 0; i < from.size(); ++i) net_.connect(from[i], 0, id, static_cast<int>(i));
  names_.resize(static_cast<std::size_t>(id) + 1);
  names_.back() = layer.name;
  last_ = id;
}

void OpenCvEngine::permute(const std::string& name, const std::vector<int>& order, int from) {
  LayerParams layer;
  layer.name = name;
  layer.set("order", cv::dnn::DictValue::arrayInt(order.data(), static_cast<int>(order.size())));
  add(layer, "Permute", {from});
}

void OpenCvEngine::reshape(const std::string& name, const std::vector<int>& dims, int from) {
  LayerParams layer;
  layer.name = name;
  layer.set("dim", cv::dnn::DictValue::arrayInt(dims.data(), static_cast<int>(dims.size())));
  add(layer, "Reshape", {from});
}

int OpenCvEngine::as_in_file(const PoseGraph& graph, int tensor) {
  if (!is_picture(graph.shape(tensor))) return made(tensor);
  permute("channels_last", {0, 2, 3, 1}, made(tensor));
  return last_;
}

void OpenCvEngine::add_convolution(const PoseGraph& graph, const GraphNode& node) {
  const bool is_depthwise = node.op == GraphOp::kDepthwise;
  const Shape& kernel = graph.shape(node.weights);
  const int out = is_depthwise ? kernel[3] : kernel[0];
  const int in = is_depthwise ? 1 : kernel[3];
  int from = made(node.inputs[0]);
  // OpenCV's convolution pads both sides alike.
  const bool is_even = node.pad_top == node.pad_bottom && node.pad_left == node.pad_right;
  if (!is_even) {
    LayerParams pad;
    pad.name = "border";
    const int amounts[] = {
        0, 0, 0, 0, node.pad_top, node.pad_bottom, node.pad_left, node.pad_right};
    pad.set("paddings", cv::dnn::DictValue::arrayInt(amounts, 8));
    add(pad, "Padding", {from});
    from = last_;
  }
  LayerParams layer;
  layer.name = "convolution";
  layer.set("kernel_h", kernel[1]);
  layer.set("kernel_w", kernel[2]);
  layer.set("stride_h", node.stride_rows);
  layer.set("stride_w", node.stride_columns);
  layer.set("pad_h", is_even ? node.pad_top : 0);
  layer.set("pad_w", is_even ? node.pad_left : 0);
  layer.set("num_output", out);
  layer.set("group", is_depthwise ? out : 1);
  layer.set("bias_term", true);
  const int sizes[] = {out, in, kernel[1], kernel[2]};
  cv::Mat weights(4, sizes, CV_32F);
  const float* from_file = graph.values(node.weights).data();
  float* to = weights.ptr<float>();
  for (int o = 0; o < out; ++o)
    for (int i = 0; i < in; ++i)
      for (int r = 0; r < kernel[1]; ++r)
        for (int c = 0; c < kernel[2]; ++c)
          *to++ = is_depthwise ? from_file[(r * kernel[2] + c) * out + o]
                               : from_file[((o * kernel[1] + r) * kernel[2] + c) * in + i];
  layer.blobs.push_back(weights);
  layer.blobs.push_back(cv::Mat(graph.values(node.bias), true).reshape(1, 1));
  add(layer, "Convolution", {from});
}

void OpenCvEngine::add_node(const PoseGraph& graph, const GraphNode& node) {
  LayerParams layer;
  const Shape& to = graph.shape(node.output);
  switch (node.op) {
    case GraphOp::kConvolution:
    case GraphOp::kDepthwise:
      add_convolution(graph, node);
      break;
    case GraphOp::kAdd:
      layer.name = "sum";
      layer.set("operation", "sum");
      add(layer, "Eltwise", {made(node.inputs[0]), made(node.inputs[1])});
      break;
    case GraphOp::kPad: {
      layer.name = "pad";
      std::vector<int> amounts;
      for (const std::size_t d : {0u, 3u, 1u, 2u}) {
        amounts.push_back(node.pad_before[d]);
        amounts.push_back(node.pad_after[d]);
      }
      layer.set("paddings", cv::dnn::DictValue::arrayInt(amounts.data(), 8));
      add(layer, "Padding", {made(node.inputs[0])});
      break;
    }
    case GraphOp::kMaxPool:
      layer.name = "pool";
      layer.set("pool", "max");
      layer.set("kernel_h", node.kernel_rows);
      layer.set("kernel_w", node.kernel_columns);
      layer.set("stride_h", node.stride_rows);
      layer.set("stride_w", node.stride_columns);
      layer.set("ceil_mode", false);
      add(layer, "Pooling", {made(node.inputs[0])});
      break;
    case GraphOp::kResizeBilinear:
      layer.name = "resize";
      layer.set("interpolation", "bilinear");
      layer.set("half_pixel_centers", true);
      layer.set("height", to[1]);
      layer.set("width", to[2]);
      add(layer, "Resize", {made(node.inputs[0])});
      break;
    case GraphOp::kReshape:
      reshape("reshape", to, as_in_file(graph, node.inputs[0]));
      if (is_picture(to)) permute("channels_first", {0, 3, 1, 2}, last_);
      break;
    case GraphOp::kLogistic:
      layer.name = "logistic";
      add(layer, "Sigmoid", {made(node.inputs[0])});
      break;
    case GraphOp::kConcatenate: {
      layer.name = "join";
      const int first[] = {0, 2, 3, 1};
      layer.set("axis", is_picture(to) ? first[node.axis] : node.axis);
      std::vector<int> parts;
      for (const int t : node.inputs) parts.push_back(made(t));
      add(layer, "Concat", parts);
      break;
    }
    case GraphOp::kClamp:
      last_ = made(node.inputs[0]);
      break;
    case GraphOp::kPrelu: {
      layer.name = "prelu";
      layer.blobs.push_back(cv::Mat(graph.values(node.weights), true).reshape(1, 1));
      add(layer, "ChannelsPReLU", {made(node.inputs[0])});
      break;
    }
    case GraphOp::kMean:
      layer.name = "mean";
      layer.set("pool", "ave");
      layer.set("global_pooling", true);
      add(layer, "Pooling", {made(node.inputs[0])});
      reshape("channels", to, last_);
      break;
    case GraphOp::kFullyConnected: {
      layer.name = "connected";
      layer.set("num_output", to[1]);
      layer.set("bias_term", true);
      layer.blobs.push_back(cv::Mat(graph.values(node.weights), true).reshape(1, to[1]));
      layer.blobs.push_back(cv::Mat(graph.values(node.bias), true).reshape(1, 1));
      add(layer, "InnerProduct", {made(node.inputs[0])});
      break;
    }
    case GraphOp::kDepthToSpace: {
      const Shape& from = graph.shape(node.inputs[0]);
      const int b = node.block;
      reshape("blocks", {1, b, b, to[3], from[1], from[2]}, made(node.inputs[0]));
      permute("blocks_out", {0, 3, 4, 1, 5, 2}, last_);
      reshape("space", {1, to[3], to[1], to[2]}, last_);
      break;
    }
  }
  if (node.least == 0.0f) {
    LayerParams clamp;
    clamp.name = "clamp";
    const bool has_top = node.most < 1e30f;
    if (has_top) {
      clamp.set("min_value", node.least);
      clamp.set("max_value", node.most);
    }
    add(clamp, has_top ? "ReLU6" : "ReLU", {last_});
  }
  made_[node.output] = last_;
}

OpenCvEngine::OpenCvEngine(const PoseGraph& graph) {
  const Shape& shape = graph.shape(graph.input);
  rows_ = shape[1];
  columns_ = shape[2];
  channels_ = shape[3];
  input_.assign(elements_of(shape), 0.0f);
  const int sizes[] = {1, channels_, rows_, columns_};
  planes_ = cv::Mat(4, sizes, CV_32F, cv::Scalar(0));
  for (int c = 0; c < channels_; ++c)
    channel_headers_.emplace_back(rows_, columns_, CV_32F, planes_.ptr<float>(0, c));
  net_.setInputsNames({"picture"});
  made_[graph.input] = 0;
  for (const GraphNode& node : graph.nodes) add_node(graph, node);
  for (const int output : graph.outputs)
    outputs_.push_back(names_[static_cast<std::size_t>(as_in_file(graph, output))]);
  net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 7)
  // Winograd convolution is faster but rounds differently. It is off so that OpenCV and XNNPACK
  // give the same numbers.
  net_.enableWinograd(false);
#endif
}

bool OpenCvEngine::run() {
  cv::split(cv::Mat(rows_, columns_, CV_32FC(channels_), input_.data()), channel_headers_);
  // OpenCV reports errors as exceptions.
  try {
    net_.setInput(planes_, "picture");
    net_.forward(results_, outputs_);
  } catch (const cv::Exception&) {
    return false;
  }
  return true;
}

}  // namespace

Result<std::unique_ptr<PoseEngine>> make_opencv_engine(const PoseGraph& graph) {
  // The cores belong to network, music and display; with more threads than one it is little faster
  // on a busy machine.
  cv::setNumThreads(1);
  try {
    std::unique_ptr<PoseEngine> engine = std::make_unique<OpenCvEngine>(graph);
    // Layers are made when they first run.
    if (!engine->run()) return fail("OpenCV cannot run this network");
    return engine;
  } catch (const cv::Exception&) {
    return fail("OpenCV cannot build this network; fetch the models again: dance-fetch-models");
  }
}

}  // namespace dance
