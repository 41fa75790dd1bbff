#include "tests/producers/camera/estimator/tiny_network.h"

#include <Eigen/Core>
#include <bit>

#include "core/base/random.h"

namespace dance {
namespace {

std::vector<std::uint8_t> as_bytes(const std::vector<std::uint16_t>& values) {
  std::vector<std::uint8_t> raw;
  for (const std::uint16_t value : values) {
    raw.push_back(static_cast<std::uint8_t>(value));
    raw.push_back(static_cast<std::uint8_t>(value >> 8));
  }
  return raw;
}

Flat tensor_table(const std::vector<int>& shape, int type, std::size_t buffer, std::size_t number) {
  Flat table;
  table.at(0, flat_numbers(shape))
      .u8(1, static_cast<std::uint8_t>(type))
      .i32(2, static_cast<std::int32_t>(buffer))
      .at(3, flat_text("t" + std::to_string(number)));
  return table;
}

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

Flat convolution_options(int padding, int stride, int activation) {
  Flat options;
  options.u8(0, static_cast<std::uint8_t>(padding))
      .i32(1, stride)
      .i32(2, stride)
      .u8(3, static_cast<std::uint8_t>(activation));
  return options;
}

Flat depthwise_options(int padding, int stride, int activation) {
  Flat options;
  options.u8(0, static_cast<std::uint8_t>(padding))
      .i32(1, stride)
      .i32(2, stride)
      .i32(3, 1)
      .u8(4, static_cast<std::uint8_t>(activation));
  return options;
}

constexpr int kAdd = 0, kJoin = 2, kConvolution = 3, kDepthwise = 4, kDepthToSpace = 5,
              kDequantize = 6, kLogistic = 14, kMaxPool = 17, kReshape = 22, kResize = 23,
              kPad = 34, kDensify = 124;

}  // namespace

int TinyFile::computed(const std::vector<int>& shape) {
  tensors_.push_back(tensor_table(shape, 0, 0, tensors_.size()));
  return static_cast<int>(tensors_.size()) - 1;
}

int TinyFile::constant(const std::vector<int>& shape, int type, std::vector<std::uint8_t> raw) {
  tensors_.push_back(tensor_table(shape, type, buffers_.size(), tensors_.size()));
  Flat buffer;
  buffer.at(0, flat_bytes(std::move(raw)));
  buffers_.push_back(buffer);
  return static_cast<int>(tensors_.size()) - 1;
}

int TinyFile::floats(const std::vector<int>& shape, const std::vector<float>& values) {
  std::vector<int> bits;
  for (const float value : values) bits.push_back(std::bit_cast<std::int32_t>(value));
  return constant(shape, 0, flat_numbers(bits).raw);
}

int TinyFile::halves(const std::vector<int>& shape, const std::vector<std::uint16_t>& bits) {
  const int packed = constant(shape, 1, as_bytes(bits));
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
  const int packed = constant(shape, 1, as_bytes(kept));
  std::vector<Flat> dimensions;
  std::vector<int> order;
  for (std::size_t d = 0; d < shape.size(); ++d) {
    order.push_back(static_cast<int>(d));
    Flat dimension;
    if (d + 1 < shape.size()) {
      dimension.i32(1, shape[d]);
    } else {
      Flat segment_table, place_table;
      segment_table.at(0, flat_bytes(as_bytes(segments), 2));
      place_table.at(0, flat_bytes(places));
      dimension.u8(0, 1).u8(2, 2).at(3, segment_table).u8(4, 3).at(5, place_table);
    }
    dimensions.push_back(dimension);
  }
  Flat sparsity;
  sparsity.at(0, flat_numbers(order)).at(2, flat_tables(dimensions));
  tensors_[static_cast<std::size_t>(packed)].at(6, sparsity);
  const int dense = computed(shape);
  add(kDensify, {packed}, dense);
  const int unpacked = computed(shape);
  add(kDequantize, {dense}, unpacked);
  return unpacked;
}

int TinyFile::integers(const std::vector<int>& shape, const std::vector<int>& values) {
  return constant(shape, 2, flat_numbers(values).raw);
}

void TinyFile::add(int builtin, const std::vector<int>& inputs, int output, Flat options) {
  Flat code;
  code.u8(0, static_cast<std::uint8_t>(builtin)).i32(3, builtin);
  Flat table;
  table.i32(0, static_cast<std::int32_t>(codes_.size()))
      .at(1, flat_numbers(inputs))
      .at(2, flat_numbers({output}))
      .at(4, std::move(options));
  codes_.push_back(code);
  operators_.push_back(table);
}

std::vector<std::uint8_t> TinyFile::file(int input, const std::vector<int>& outputs) const {
  Flat graph;
  graph.at(0, flat_tables(tensors_))
      .at(1, flat_numbers({input}))
      .at(2, flat_numbers(outputs))
      .at(3, flat_tables(operators_));
  Flat model;
  model.i32(0, 3)
      .at(1, flat_tables(codes_))
      .at(2, flat_tables({graph}))
      .at(4, flat_tables(buffers_));
  return FlatWriter::write(model);
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
           first, convolution_options(0, 2, 3));
  const int second = file.computed({1, 4, 4, 6});
  file.add(kDepthwise,
           {first, file.sparse_halves({1, 5, 5, 6}, numbers.halves(150)),
            file.floats({6}, numbers.floats(6))},
           second, depthwise_options(0, 1, 0));
  const int sum = file.computed({1, 4, 4, 6});
  Flat relu;
  relu.u8(0, 1);
  file.add(kAdd, {first, second}, sum, relu);
  const int pooled = file.computed({1, 2, 2, 6});
  Flat pool;
  pool.u8(0, 1).i32(1, 2).i32(2, 2).i32(3, 2).i32(4, 2);
  file.add(kMaxPool, {sum}, pooled, pool);
  const int wider = file.computed({1, 2, 2, 8});
  file.add(kPad, {pooled, file.integers({4, 2}, {0, 0, 0, 0, 0, 0, 0, 2})}, wider);
  const int space = file.computed({1, 4, 4, 2});
  Flat blocks;
  blocks.i32(0, 2);
  file.add(kDepthToSpace, {wider}, space, blocks);
  const int framed = file.computed({1, 6, 6, 2});
  file.add(kPad, {space, file.integers({4, 2}, {0, 0, 1, 1, 1, 1, 0, 0})}, framed);
  const int third = file.computed({1, 2, 2, 4});
  file.add(
      kConvolution,
      {framed, file.floats({4, 3, 3, 2}, numbers.floats(72)), file.floats({4}, numbers.floats(4))},
      third, convolution_options(1, 2, 0));
  const int flat = file.computed({1, 16});
  file.add(kReshape, {third}, flat);
  const int narrow = file.computed({1, 2, 2, 2});
  file.add(
      kConvolution,
      {pooled, file.floats({2, 1, 1, 6}, numbers.floats(12)), file.floats({2}, numbers.floats(2))},
      narrow, convolution_options(0, 1, 0));
  const int sure = file.computed({1, 2, 2, 2});
  file.add(kLogistic, {narrow}, sure);
  const int flat_too = file.computed({1, 8});
  file.add(kReshape, {sure}, flat_too);
  const int joined = file.computed({1, 24});
  Flat axis;
  axis.i32(0, 1);
  file.add(kJoin, {flat, flat_too}, joined, axis);
  const int larger = file.computed({1, 4, 4, 6});
  Flat half_pixels;
  half_pixels.u8(3, 1);
  file.add(kResize, {pooled, file.integers({2}, {4, 4})}, larger, half_pixels);
  return file.file(picture, {joined, larger});
}

std::vector<std::uint8_t> tiny_convolution_file() {
  TinyFile file;
  const int picture = file.computed({1, 2, 2, 1});
  const int out = file.computed({1, 2, 2, 1});
  file.add(kConvolution, {picture, file.halves({1, 1, 1, 1}, {0x3c00}), file.floats({1}, {0.5f})},
           out, convolution_options(0, 1, 0));
  return file.file(picture, {out});
}

}  // namespace dance
