#include "producers/camera/estimator/tflite_tensors.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace dance {
namespace {

constexpr std::size_t kMostTensors = 4096;
constexpr std::size_t kMostDimensions = 4;
constexpr std::size_t kMostElements = 1u << 22;
constexpr std::size_t kMostConstants = 1u << 24;
constexpr int kFloat32 = 0, kFloat16 = 1, kInt32 = 2;
constexpr int kSparseFormat = 1;

std::size_t width_of(int type) { return type == kFloat16 ? 2 : 4; }

template <class Numbers>
std::vector<std::size_t> copied(const Numbers* numbers) {
  if (!numbers || !numbers->values() || numbers->values()->size() > kMostElements + 1) return {};
  return {numbers->values()->begin(), numbers->values()->end()};
}

std::vector<std::size_t> numbers_of(const void* numbers, tflite::IndexVector kind) {
  switch (kind) {
    case tflite::IndexVector::Int32Vector:
      return copied(static_cast<const tflite::Int32Vector*>(numbers));
    case tflite::IndexVector::Uint16Vector:
      return copied(static_cast<const tflite::Uint16Vector*>(numbers));
    case tflite::IndexVector::Uint8Vector:
      return copied(static_cast<const tflite::Uint8Vector*>(numbers));
    case tflite::IndexVector::NONE:
      break;
  }
  return {};
}

}  // namespace

Result<TfliteTensors> TfliteTensors::read(const tflite::Model& model,
                                          const tflite::Subgraph& subgraph) {
  TfliteTensors tensors;
  const std::size_t count = subgraph.tensors()->size();
  if (count == 0 || count > kMostTensors)
    return fail("it has " + std::to_string(count) + " tensors, where 1 to " +
                std::to_string(kMostTensors) + " are read");
  tensors.tensors_.reserve(count);
  for (const tflite::Tensor* table : *subgraph.tensors()) {
    if (auto done = tensors.read_tensor(*table, model); !done)
      return tl::make_unexpected(done.error());
  }
  return tensors;
}

Result<void> TfliteTensors::read_tensor(const tflite::Tensor& table, const tflite::Model& model) {
  const std::string which = "tensor " + std::to_string(tensors_.size());
  Tensor tensor;
  if (table.name()) tensor.name = table.name()->string_view().substr(0, 64);
  tensor.type = table.type();
  tensor.sparsity = table.sparsity();
  const std::size_t dimensions = table.shape() ? table.shape()->size() : 0;
  if (dimensions > kMostDimensions)
    return fail(which + " has " + std::to_string(dimensions) + " dimensions");
  std::size_t elements = 1;
  for (std::uint32_t d = 0; d < dimensions; ++d) {
    const std::int32_t size = table.shape()->Get(d);
    if (size < 1 || static_cast<std::size_t>(size) > kMostElements / elements)
      return fail(which + " has a dimension of " + std::to_string(size));
    elements *= static_cast<std::size_t>(size);
    tensor.shape.push_back(size);
  }
  const std::uint32_t buffer = table.buffer();
  if (buffer >= model.buffers()->size()) return fail(which + " lies in a buffer that is not there");
  // Buffer 0 is by definition empty.
  const auto* data = buffer == 0 ? nullptr : model.buffers()->Get(buffer)->data();
  if (data) tensor.data = {data->data(), data->size()};
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

bool TfliteTensors::is_constant(int tensor) const { return !source_of(tensor).data.empty(); }

Result<std::vector<float>> TfliteTensors::stored_floats(const Tensor& tensor,
                                                        std::size_t count) const {
  if (tensor.type != kFloat32 && tensor.type != kFloat16)
    return fail("'" + tensor.name + "' holds numbers of type " + std::to_string(tensor.type) +
                ", which is neither single nor half precision");
  const std::size_t width = width_of(tensor.type);
  if (tensor.data.size() != count * width)
    return fail("'" + tensor.name + "' has " + std::to_string(tensor.data.size()) +
                " bytes, where " + std::to_string(count * width) + " are due");
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* at = tensor.data.data() + i * width;
    values[i] = width == 4 ? flatbuffers::ReadScalar<float>(at)
                           : Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(
                                 flatbuffers::ReadScalar<std::uint16_t>(at)));
    if (!(std::abs(values[i]) <= std::numeric_limits<float>::max()))
      return fail("'" + tensor.name + "' holds what is no finite number");
  }
  return values;
}

// As the pose networks have them: dense in all dimensions but the last, of which the places that
// are not 0 are listed.
Result<std::vector<float>> TfliteTensors::dense(const Tensor& tensor) const {
  const std::size_t rank = tensor.shape.size();
  const auto& order = *tensor.sparsity->traversal_order();
  const auto& dimensions = *tensor.sparsity->dimensions();
  const auto* blocks = tensor.sparsity->block_map();
  const auto wrong = [&](const char* what) {
    return fail("'" + tensor.name + "' is sparse: " + what);
  };
  if (rank == 0 || order.size() != rank || dimensions.size() != rank ||
      (blocks && blocks->size() != 0))
    return wrong("its dimensions are not listed one by one");
  std::size_t rows = 1;
  for (std::uint32_t d = 0; d < rank; ++d) {
    const bool is_last = d + 1 == rank;
    if (order.Get(d) != static_cast<std::int32_t>(d) ||
        (dimensions.Get(d)->format() == kSparseFormat) != is_last)
      return wrong("only the last dimension may be listed by place");
    if (is_last) break;
    if (dimensions.Get(d)->dense_size() != tensor.shape[d])
      return wrong("a dimension's size is not the shape's");
    rows *= static_cast<std::size_t>(tensor.shape[d]);
  }
  const tflite::DimensionMetadata& last = *dimensions.Get(static_cast<std::uint32_t>(rank) - 1);
  const std::vector<std::size_t> segments = numbers_of(last.segments(), last.segments_type());
  const std::vector<std::size_t> indices = numbers_of(last.indices(), last.indices_type());
  if (segments.size() != rows + 1 || segments.front() != 0 || segments.back() != indices.size())
    return wrong("its list of places is not as long as it says");
  DANCE_TRY(const std::vector<float> stored, stored_floats(tensor, indices.size()));
  const auto columns = static_cast<std::size_t>(tensor.shape.back());
  std::vector<float> values(rows * columns, 0.0f);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t from = segments[row], to = segments[row + 1];
    if (from > to || to > indices.size()) return wrong("its rows go backwards");
    for (std::size_t i = from; i < to; ++i) {
      if (indices[i] >= columns) return wrong("a place is beyond its row");
      values[row * columns + indices[i]] = stored[i];
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
  return source.sparsity ? dense(source) : stored_floats(source, count);
}

Result<std::vector<int>> TfliteTensors::integers(int tensor) {
  const Tensor& source = source_of(tensor);
  const std::size_t count = elements_of(source.shape);
  if (source.type != kInt32 || count > 64 || source.data.size() != 4 * count)
    return fail("'" + source.name + "' is no short list of whole numbers");
  std::vector<int> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(flatbuffers::ReadScalar<std::int32_t>(source.data.data() + 4 * i));
  return values;
}

}  // namespace dance
