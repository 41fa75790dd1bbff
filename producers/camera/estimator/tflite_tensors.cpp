#include "producers/camera/estimator/tflite_tensors.h"

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <limits>

namespace dance {
namespace {

constexpr std::size_t kMostTensors = 4096;
constexpr std::size_t kMostDimensions = 4;
constexpr std::size_t kMostElements = 1u << 22;
constexpr std::size_t kMostConstants = 1u << 24;
constexpr int kFloat32 = 0, kFloat16 = 1, kInt32 = 2;
// Fields of the schema's tables.
constexpr std::size_t kModelBuffers = 4, kSubgraphTensors = 0, kBufferData = 0;
constexpr std::size_t kTensorShape = 0, kTensorType = 1, kTensorBuffer = 2, kTensorName = 3,
                      kTensorSparsity = 6;
constexpr std::size_t kTraversalOrder = 0, kBlockMap = 1, kDimensions = 2;
constexpr std::size_t kFormat = 0, kDenseSize = 1, kSegmentsType = 2, kSegments = 3,
                      kIndicesType = 4, kIndices = 5;
constexpr int kSparseFormat = 1;

std::size_t width_of(int type) { return type == kFloat16 ? 2 : 4; }

// Whole numbers of a table that says itself how wide they are.
FlatVector numbers_of(const FlatTable& dimension, std::size_t type_field, std::size_t field) {
  constexpr std::size_t kWidths[] = {0, 4, 2, 1};
  const std::size_t type = dimension.u8(type_field);
  if (type == 0 || type >= std::size(kWidths)) return {};
  return dimension.table(field).vector(0, kWidths[type]);
}

}  // namespace

Result<TfliteTensors> TfliteTensors::read(FlatBytes& file, FlatTable model, FlatTable subgraph) {
  TfliteTensors tensors(file);
  const FlatVector tables = subgraph.vector(kSubgraphTensors, 4);
  const FlatVector buffers = model.vector(kModelBuffers, 4);
  if (tables.count == 0 || tables.count > kMostTensors)
    return fail("it has " + std::to_string(tables.count) + " tensors, where 1 to " +
                std::to_string(kMostTensors) + " are read");
  tensors.tensors_.reserve(tables.count);
  for (std::size_t i = 0; i < tables.count; ++i) {
    if (auto done = tensors.read_tensor(subgraph.table_of(tables, i), model, buffers); !done)
      return tl::make_unexpected(done.error());
  }
  return tensors;
}

Result<void> TfliteTensors::read_tensor(const FlatTable& table, const FlatTable& model,
                                        const FlatVector& buffers) {
  const std::string which = "tensor " + std::to_string(tensors_.size());
  Tensor tensor;
  tensor.name = table.text(kTensorName).substr(0, 64);
  tensor.type = table.u8(kTensorType);
  tensor.sparsity = table.table(kTensorSparsity);
  const FlatVector shape = table.vector(kTensorShape, 4);
  if (shape.count > kMostDimensions)
    return fail(which + " has " + std::to_string(shape.count) + " dimensions");
  std::size_t elements = 1;
  for (std::size_t d = 0; d < shape.count; ++d) {
    const std::int32_t size = shape.i32(d);
    if (size < 1 || static_cast<std::size_t>(size) > kMostElements / elements)
      return fail(which + " has a dimension of " + std::to_string(size));
    elements *= static_cast<std::size_t>(size);
    tensor.shape.push_back(size);
  }
  const std::size_t buffer = table.u32(kTensorBuffer);
  if (buffer >= buffers.count) return fail(which + " lies in a buffer that is not there");
  // Buffer 0 is by definition empty.
  if (buffer != 0) tensor.data = model.table_of(buffers, buffer).vector(kBufferData, 1);
  if (!file_->ok()) return fail(which + " points out of the file");
  tensors_.push_back(std::move(tensor));
  return {};
}

void TfliteTensors::set_same(int from, int to) {
  tensors_[static_cast<std::size_t>(to)].same_as = from;
}

// set_same() is only called for what is no constant yet, so that there are no circles.
const TfliteTensors::Tensor& TfliteTensors::source_of(int tensor) const {
  while (at(tensor).same_as >= 0) tensor = at(tensor).same_as;
  return at(tensor);
}

bool TfliteTensors::is_constant(int tensor) const { return source_of(tensor).data.count > 0; }

Result<std::vector<float>> TfliteTensors::stored_floats(const Tensor& tensor,
                                                        std::size_t count) const {
  if (tensor.type != kFloat32 && tensor.type != kFloat16)
    return fail("'" + tensor.name + "' holds numbers of type " + std::to_string(tensor.type) +
                ", which is neither single nor half precision");
  const std::size_t width = width_of(tensor.type);
  if (tensor.data.count != count * width)
    return fail("'" + tensor.name + "' has " + std::to_string(tensor.data.count) +
                " bytes, where " + std::to_string(count * width) + " are due");
  const auto bytes = tensor.data.bytes();
  // Nothing more is read once something pointed out of the file.
  if (bytes.size() != count * width) return fail("'" + tensor.name + "' is not in the file");
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (width == 2) {
      const auto bits = static_cast<std::uint16_t>(bytes[2 * i] | bytes[2 * i + 1] << 8);
      values[i] = Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(bits));
    } else {
      std::uint32_t bits = 0;
      for (std::size_t b = 0; b < 4; ++b)
        bits |= static_cast<std::uint32_t>(bytes[4 * i + b]) << (8 * b);
      values[i] = std::bit_cast<float>(bits);
    }
    if (!(std::abs(values[i]) <= std::numeric_limits<float>::max()))
      return fail("'" + tensor.name + "' holds what is no finite number");
  }
  return values;
}

// As the pose networks have them: dense in all dimensions but the last, of which the places that
// are not 0 are listed.
Result<std::vector<float>> TfliteTensors::dense(const Tensor& tensor) const {
  const std::size_t rank = tensor.shape.size();
  const FlatVector order = tensor.sparsity.vector(kTraversalOrder, 4);
  const FlatVector dimensions = tensor.sparsity.vector(kDimensions, 4);
  const auto wrong = [&](const char* what) {
    return fail("'" + tensor.name + "' is sparse: " + what);
  };
  if (rank == 0 || order.count != rank || dimensions.count != rank ||
      tensor.sparsity.vector(kBlockMap, 4).count != 0)
    return wrong("its dimensions are not listed one by one");
  std::size_t rows = 1;
  for (std::size_t d = 0; d < rank; ++d) {
    const FlatTable dimension = tensor.sparsity.table_of(dimensions, d);
    const bool is_last = d + 1 == rank;
    if (order.i32(d) != static_cast<std::int32_t>(d) ||
        (dimension.u8(kFormat) == kSparseFormat) != is_last)
      return wrong("only the last dimension may be listed by place");
    if (is_last) break;
    if (dimension.i32(kDenseSize) != tensor.shape[d])
      return wrong("a dimension's size is not the shape's");
    rows *= static_cast<std::size_t>(tensor.shape[d]);
  }
  const FlatTable last = tensor.sparsity.table_of(dimensions, rank - 1);
  const FlatVector segments = numbers_of(last, kSegmentsType, kSegments);
  const FlatVector indices = numbers_of(last, kIndicesType, kIndices);
  if (segments.count != rows + 1 || segments.number(0) != 0 ||
      segments.number(rows) != indices.count)
    return wrong("its list of places is not as long as it says");
  DANCE_TRY(const std::vector<float> stored, stored_floats(tensor, indices.count));
  const auto columns = static_cast<std::size_t>(tensor.shape.back());
  std::vector<float> values(rows * columns, 0.0f);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t from = segments.number(row), to = segments.number(row + 1);
    if (from > to || to > indices.count) return wrong("its rows go backwards");
    for (std::size_t i = from; i < to; ++i) {
      const std::size_t column = indices.number(i);
      if (column >= columns) return wrong("a place is beyond its row");
      values[row * columns + column] = stored[i];
    }
  }
  return values;
}

Result<std::vector<float>> TfliteTensors::floats(int tensor) {
  const Tensor& source = source_of(tensor);
  const std::size_t count = elements_of(at(tensor).shape);
  if (at(tensor).shape != source.shape)
    return fail("'" + source.name + "' is not of the shape of what is made of it");
  elements_read_ += count;
  if (elements_read_ > kMostConstants)
    return fail("it has more than " + std::to_string(kMostConstants) + " weights");
  return source.sparsity.is_there() ? dense(source) : stored_floats(source, count);
}

Result<std::vector<int>> TfliteTensors::integers(int tensor) {
  const Tensor& source = source_of(tensor);
  const std::size_t count = elements_of(source.shape);
  if (source.type != kInt32 || count > 64 || source.data.count != 4 * count)
    return fail("'" + source.name + "' is no short list of whole numbers");
  std::vector<int> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(file_->i32(source.data.at + 4 * i));
  return values;
}

}  // namespace dance
