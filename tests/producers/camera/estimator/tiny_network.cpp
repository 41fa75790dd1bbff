#include "tests/producers/camera/estimator/tiny_network.h"

#include <Eigen/Core>
#include <bit>
#include <cstring>
#include <numeric>
#include <string>

#include "core/base/random.h"

namespace dance {
namespace {

class Numbers {
 public:
  float next() { return static_cast<float>(random_.uniform(-1.0, 1.0)); }
  std::vector<float> floats(std::size_t count) {
    std::vector<float> values(count);
    for (float& value : values) value = next();
    return values;
  }
  std::vector<std::uint16_t> halves(std::size_t count) {
    std::vector<std::uint16_t> values(count);
    for (auto& value : values) value = std::bit_cast<std::uint16_t>(Eigen::half(next()));
    return values;
  }

 private:
  Random random_{41};
};

constexpr int kAdd = 0, kJoin = 2, kConvolution = 3, kDepthwise = 4, kDepthToSpace = 5,
              kDequantize = 6, kConnected = 9, kLogistic = 14, kMaxPool = 17, kRelu = 19,
              kReshape = 22, kResize = 23, kPad = 34, kMean = 40, kSlice = 45, kPrelu = 54,
              kDensify = 124;

}  // namespace

int TinyFile::add_tensor(const std::vector<int>& shape, int type, std::size_t buffer,
                         flatbuffers::Offset<tflite::Sparsity> sparsity) {
  const std::string name = "t" + std::to_string(tensors_.size());
  tensors_.push_back(tflite::CreateTensorDirect(builder_, &shape, static_cast<std::int8_t>(type),
                                                static_cast<std::uint32_t>(buffer), name.c_str(),
                                                sparsity));
  return static_cast<int>(tensors_.size()) - 1;
}

int TinyFile::computed(const std::vector<int>& shape) { return add_tensor(shape, 0, 0); }

template <class T>
int TinyFile::constant(const std::vector<int>& shape, int type, const std::vector<T>& values,
                       flatbuffers::Offset<tflite::Sparsity> sparsity) {
  std::vector<std::uint8_t> raw(values.size() * sizeof(T));
  std::memcpy(raw.data(), values.data(), raw.size());
  buffers_.push_back(tflite::CreateBufferDirect(builder_, &raw));
  return add_tensor(shape, type, buffers_.size() - 1, sparsity);
}

int TinyFile::floats(const std::vector<int>& shape, const std::vector<float>& values) {
  return constant(shape, 0, values);
}

int TinyFile::halves(const std::vector<int>& shape, const std::vector<std::uint16_t>& bits) {
  const int packed = constant(shape, 1, bits);
  const int unpacked = computed(shape);
  add(kDequantize, {packed}, unpacked);
  return unpacked;
}

// Of every row of the last dimension the first half is kept.
int TinyFile::sparse_halves(const std::vector<int>& shape, const std::vector<std::uint16_t>& bits) {
  const auto columns = static_cast<std::size_t>(shape.back());
  std::vector<std::uint16_t> kept;
  std::vector<std::uint16_t> segments{0};
  std::vector<std::uint8_t> places;
  for (std::size_t row = 0; row < bits.size() / columns; ++row) {
    for (std::size_t c = 0; c < columns / 2; ++c) {
      kept.push_back(bits[row * columns + c]);
      places.push_back(static_cast<std::uint8_t>(c));
    }
    segments.push_back(static_cast<std::uint16_t>(places.size()));
  }
  std::vector<int> order(shape.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<flatbuffers::Offset<tflite::DimensionMetadata>> dimensions;
  for (std::size_t d = 0; d + 1 < shape.size(); ++d)
    dimensions.push_back(tflite::CreateDimensionMetadata(builder_, 0, shape[d]));
  const auto segment_table = tflite::CreateUint16VectorDirect(builder_, &segments).Union();
  const auto place_table = tflite::CreateUint8VectorDirect(builder_, &places).Union();
  dimensions.push_back(tflite::CreateDimensionMetadata(
      builder_, 1, 0, tflite::IndexVector::Uint16Vector, segment_table,
      tflite::IndexVector::Uint8Vector, place_table));
  const int packed = constant(shape, 1, kept,
                              tflite::CreateSparsityDirect(builder_, &order, nullptr, &dimensions));
  const int dense = computed(shape);
  add(kDensify, {packed}, dense);
  const int unpacked = computed(shape);
  add(kDequantize, {dense}, unpacked);
  return unpacked;
}

int TinyFile::integers(const std::vector<int>& shape, const std::vector<int>& values) {
  return constant(shape, 2, values);
}

void TinyFile::add(int builtin, const std::vector<int>& inputs, int output, TinyOptions options) {
  const std::vector<int> outputs{output};
  operators_.push_back(
      tflite::CreateOperatorDirect(builder_, static_cast<std::uint32_t>(codes_.size()), &inputs,
                                   &outputs, options.kind, options.table));
  codes_.push_back(
      tflite::CreateOperatorCode(builder_, static_cast<std::uint8_t>(builtin), builtin));
}

TinyOptions TinyFile::convolution(int padding, int stride, int activation) {
  return options(tflite::CreateConvolutionOptions(builder_, static_cast<std::int8_t>(padding),
                                                  stride, stride,
                                                  static_cast<std::int8_t>(activation)));
}

std::vector<std::uint8_t> TinyFile::file(int input, const std::vector<int>& outputs) {
  const std::vector<int> inputs{input};
  const std::vector<flatbuffers::Offset<tflite::Subgraph>> graphs{
      tflite::CreateSubgraphDirect(builder_, &tensors_, &inputs, &outputs, &operators_)};
  tflite::FinishModelBuffer(builder_,
                            tflite::CreateModelDirect(builder_, 3, &codes_, &graphs, &buffers_));
  return {builder_.GetBufferPointer(), builder_.GetBufferPointer() + builder_.GetSize()};
}

std::vector<std::uint8_t> tiny_network_file() {
  TinyFile file;
  Numbers numbers;
  const int picture = file.computed({1, 8, 8, 4});
  // Steps of two with SAME padding: one more behind than before.
  const int first = file.computed({1, 4, 4, 6});
  file.add(kConvolution,
           {picture, file.halves({6, 3, 3, 4}, numbers.halves(216)),
            file.floats({6}, numbers.floats(6))},
           first, file.convolution(0, 2, 3));
  const int second = file.computed({1, 4, 4, 6});
  file.add(kDepthwise,
           {first, file.sparse_halves({1, 5, 5, 6}, numbers.halves(150)),
            file.floats({6}, numbers.floats(6))},
           second, file.options(tflite::CreateDepthwiseOptions(file.builder(), 0, 1, 1)));
  const int sum = file.computed({1, 4, 4, 6});
  file.add(kAdd, {first, second}, sum, file.options(tflite::CreateAddOptions(file.builder(), 1)));
  const int pooled = file.computed({1, 2, 2, 6});
  file.add(kMaxPool, {sum}, pooled,
           file.options(tflite::CreatePoolOptions(file.builder(), 1, 2, 2, 2, 2)));
  const int wider = file.computed({1, 2, 2, 8});
  file.add(kPad, {pooled, file.integers({4, 2}, {0, 0, 0, 0, 0, 0, 0, 2})}, wider);
  const int space = file.computed({1, 4, 4, 2});
  file.add(kDepthToSpace, {wider}, space,
           file.options(tflite::CreateDepthToSpaceOptions(file.builder(), 2)));
  const int framed = file.computed({1, 6, 6, 2});
  file.add(kPad, {space, file.integers({4, 2}, {0, 0, 1, 1, 1, 1, 0, 0})}, framed);
  const int third = file.computed({1, 2, 2, 4});
  file.add(
      kConvolution,
      {framed, file.floats({4, 3, 3, 2}, numbers.floats(72)), file.floats({4}, numbers.floats(4))},
      third, file.convolution(1, 2, 0));
  const int flat = file.computed({1, 16});
  file.add(kReshape, {third}, flat);
  const int narrow = file.computed({1, 2, 2, 2});
  file.add(
      kConvolution,
      {pooled, file.floats({2, 1, 1, 6}, numbers.floats(12)), file.floats({2}, numbers.floats(2))},
      narrow, file.convolution(0, 1, 0));
  const int sure = file.computed({1, 2, 2, 2});
  file.add(kLogistic, {narrow}, sure);
  const int flat_too = file.computed({1, 8});
  file.add(kReshape, {sure}, flat_too);
  const int joined = file.computed({1, 24});
  file.add(kJoin, {flat, flat_too}, joined,
           file.options(tflite::CreateConcatenationOptions(file.builder(), 1)));
  const int larger = file.computed({1, 4, 4, 6});
  file.add(kResize, {pooled, file.integers({2}, {4, 4})}, larger,
           file.options(tflite::CreateResizeBilinearOptions(file.builder(), false, true)));
  return file.file(picture, {joined, larger});
}

std::vector<std::uint8_t> tiny_hand_network_file() {
  TinyFile file;
  Numbers numbers;
  const int picture = file.computed({1, 8, 8, 4});
  const int first = file.computed({1, 4, 4, 6});
  file.add(
      kConvolution,
      {picture, file.floats({6, 2, 2, 4}, numbers.floats(96)), file.floats({6}, numbers.floats(6))},
      first, file.convolution(1, 2, 0));
  const int bent = file.computed({1, 4, 4, 6});
  file.add(kPrelu, {first, file.halves({1, 1, 6}, numbers.halves(6))}, bent);
  const int narrow = file.computed({1, 4, 4, 3});
  file.add(kSlice,
           {bent, file.integers({4}, {0, 0, 0, 0}), file.integers({4}, {1, 4, 4, 3}),
            file.integers({4}, {1, 1, 1, 1})},
           narrow, file.options(tflite::CreateStridedSliceOptions(file.builder())));
  const int scaled = file.computed({1, 4, 4, 3});
  file.add(
      kDepthwise,
      {narrow, file.floats({1, 1, 1, 3}, numbers.floats(3)), file.floats({3}, numbers.floats(3))},
      scaled, file.options(tflite::CreateDepthwiseOptions(file.builder(), 1, 1, 1)));
  const int above = file.computed({1, 4, 4, 3});
  file.add(kRelu, {scaled}, above);
  const int sum = file.computed({1, 4, 4, 3});
  file.add(kAdd, {above, narrow}, sum, file.options(tflite::CreateAddOptions(file.builder(), 0)));
  const int mean = file.computed({1, 3});
  file.add(kMean, {sum, file.integers({2}, {1, 2})}, mean,
           file.options(tflite::CreateMeanOptions(file.builder())));
  const int out = file.computed({1, 5});
  file.add(kConnected,
           {mean, file.halves({5, 3}, numbers.halves(15)), file.floats({5}, numbers.floats(5))},
           out, file.options(tflite::CreateFullyConnectedOptions(file.builder())));
  const int sure = file.computed({1, 5});
  file.add(kLogistic, {out}, sure);
  return file.file(picture, {out, sure});
}

std::vector<std::uint8_t> tiny_convolution_file() {
  TinyFile file;
  const int picture = file.computed({1, 2, 2, 1});
  const int out = file.computed({1, 2, 2, 1});
  file.add(kConvolution, {picture, file.halves({1, 1, 1, 1}, {0x3c00}), file.floats({1}, {0.5f})},
           out, file.convolution(0, 1, 0));
  return file.file(picture, {out});
}

}  // namespace dance
