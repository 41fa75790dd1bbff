#include "formats/gltf/glb_accessor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace dance {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian, and copied");

constexpr std::size_t kLongestStride_bytes = 252;

template <class Number>
Number copied(const unsigned char* at) {
  Number value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// glTF's rule for normalised integers: c / (2^bits − 1), or max(c / (2^(bits−1) − 1), −1).
template <class Integer>
float float_from(const unsigned char* at, bool is_normalised) {
  const auto value = static_cast<float>(copied<Integer>(at));
  if (!is_normalised) return value;
  return std::max(value / static_cast<float>(std::numeric_limits<Integer>::max()), -1.0f);
}

float float_at(const unsigned char* at, int type, bool is_normalised) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return float_from<std::int8_t>(at, is_normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return float_from<std::uint8_t>(at, is_normalised);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return float_from<std::int16_t>(at, is_normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return float_from<std::uint16_t>(at, is_normalised);
    default:
      return copied<float>(at);
  }
}

std::uint32_t integer_at(const unsigned char* at, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return copied<std::uint8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return copied<std::uint16_t>(at);
    default:
      return copied<std::uint32_t>(at);
  }
}

std::size_t size_of_float(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

std::size_t size_of_integer(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return 4;
    default:
      return 0;
  }
}

std::string named(int accessor) { return "accessor " + std::to_string(accessor); }

// Elements that lie in the file, one every `stride` bytes.
struct Elements {
  const unsigned char* begin = nullptr;
  std::size_t stride = 0;

  const unsigned char* at(std::size_t element) const { return begin + element * stride; }
};

Result<Elements> checked_elements(const tinygltf::Model& model, const std::string& what, int view,
                                  std::size_t offset, std::size_t element_bytes,
                                  std::size_t count) {
  if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size())
    return fail(what + " has no buffer view");
  const auto bytes = bytes_of_view(model, view);
  if (!bytes) return fail(what + ": " + bytes.error().what);
  const std::size_t said = model.bufferViews[static_cast<std::size_t>(view)].byteStride;
  const std::size_t stride = said != 0 ? said : element_bytes;
  if (stride < element_bytes || stride > std::max(kLongestStride_bytes, element_bytes) ||
      offset > bytes->size() || bytes->size() - offset < element_bytes ||
      (bytes->size() - offset - element_bytes) / stride < count - 1)
    return fail(what + " reaches beyond its buffer view");
  return Elements{bytes->data() + offset, stride};
}

struct Wanted {
  std::size_t components;
  std::size_t most_values;
  std::size_t (*component_bytes)(int type);
  bool may_be_sparse;
};

Result<const tinygltf::Accessor*> checked_accessor(const tinygltf::Model& model, int index,
                                                   const Wanted& wanted) {
  const std::string what = named(index);
  if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size())
    return fail(what + " is not in the file");
  const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
  if (accessor.sparse.isSparse && !wanted.may_be_sparse)
    return fail(what + " is sparse; export the animation without");
  if (accessor.type != glb_type_of(wanted.components))
    return fail(what + " has another type than its use");
  if (wanted.component_bytes(accessor.componentType) == 0)
    return fail(what + " has a component type that its use cannot have");
  if (accessor.count == 0) return fail(what + " is empty");
  if (accessor.count > wanted.most_values / wanted.components)
    return fail(what + " holds too many numbers");
  return &accessor;
}

// Calls put(element, bytes) for each element of the view, then again for those that are replaced.
template <class Put>
Result<void> for_each_element(const tinygltf::Model& model, int index, const Wanted& wanted,
                              const tinygltf::Accessor& accessor, const Put& put) {
  const std::string what = named(index);
  const std::size_t size = wanted.component_bytes(accessor.componentType) * wanted.components;
  if (!accessor.sparse.isSparse || accessor.bufferView >= 0) {
    DANCE_TRY(const Elements elements, checked_elements(model, what, accessor.bufferView,
                                                        accessor.byteOffset, size, accessor.count));
    for (std::size_t i = 0; i < accessor.count; ++i) put(i, elements.at(i));
  }
  if (!accessor.sparse.isSparse) return {};
  const auto& sparse = accessor.sparse;
  const std::size_t index_bytes = size_of_integer(sparse.indices.componentType);
  if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > accessor.count ||
      index_bytes == 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    return fail(what + " is sparse with broken numbers");
  const auto count = static_cast<std::size_t>(sparse.count);
  if (count == 0) return {};
  DANCE_TRY(
      const Elements indices,
      checked_elements(model, what, sparse.indices.bufferView,
                       static_cast<std::size_t>(sparse.indices.byteOffset), index_bytes, count));
  DANCE_TRY(const Elements values,
            checked_elements(model, what, sparse.values.bufferView,
                             static_cast<std::size_t>(sparse.values.byteOffset), size, count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t element = integer_at(indices.at(i), sparse.indices.componentType);
    if (element >= accessor.count) return fail(what + " replaces an element that it does not have");
    put(element, values.at(i));
  }
  return {};
}

Result<std::vector<float>> read(const tinygltf::Model& model, int index, const Wanted& wanted,
                                bool normalises_all) {
  DANCE_TRY(const tinygltf::Accessor* accessor, checked_accessor(model, index, wanted));
  const int type = accessor->componentType;
  const bool is_normalised = normalises_all || accessor->normalized;
  const std::size_t step = wanted.component_bytes(type);
  std::vector<float> values;
  // What is not backed by the file's own bytes is made only after those are checked.
  const auto put = [&](std::size_t element, const unsigned char* at) {
    if (values.empty()) values.resize(accessor->count * wanted.components);
    float* out = values.data() + element * wanted.components;
    for (std::size_t c = 0; c < wanted.components; ++c)
      out[c] = float_at(at + c * step, type, is_normalised);
  };
  if (auto done = for_each_element(model, index, wanted, *accessor, put); !done)
    return tl::make_unexpected(done.error());
  values.resize(accessor->count * wanted.components);
  for (const float value : values)
    if (!std::isfinite(value)) return fail(named(index) + " holds a number that is not finite");
  return values;
}

}  // namespace

int glb_type_of(std::size_t components) {
  switch (components) {
    case 1:
      return TINYGLTF_TYPE_SCALAR;
    case 2:
      return TINYGLTF_TYPE_VEC2;
    case 3:
      return TINYGLTF_TYPE_VEC3;
    case 4:
      return TINYGLTF_TYPE_VEC4;
    default:
      return TINYGLTF_TYPE_MAT4;
  }
}

Result<std::vector<float>> read_floats(const tinygltf::Model& model, int accessor,
                                       std::size_t components, std::size_t most_values) {
  return read(model, accessor, {components, most_values, &size_of_float, false}, true);
}

Result<std::vector<float>> read_attribute(const tinygltf::Model& model, int accessor,
                                          std::size_t components, std::size_t most_values) {
  return read(model, accessor, {components, most_values, &size_of_float, true}, false);
}

Result<std::vector<std::uint32_t>> read_integers(const tinygltf::Model& model, int index,
                                                 std::size_t components, std::size_t most_values) {
  const Wanted wanted{components, most_values, &size_of_integer, true};
  DANCE_TRY(const tinygltf::Accessor* accessor, checked_accessor(model, index, wanted));
  const int type = accessor->componentType;
  const std::size_t step = size_of_integer(type);
  std::vector<std::uint32_t> values;
  const auto put = [&](std::size_t element, const unsigned char* at) {
    if (values.empty()) values.resize(accessor->count * components);
    for (std::size_t c = 0; c < components; ++c)
      values[element * components + c] = integer_at(at + c * step, type);
  };
  if (auto done = for_each_element(model, index, wanted, *accessor, put); !done)
    return tl::make_unexpected(done.error());
  values.resize(accessor->count * components);
  return values;
}

std::size_t element_count(const tinygltf::Model& model, int accessor) {
  if (accessor < 0 || static_cast<std::size_t>(accessor) >= model.accessors.size()) return 0;
  return model.accessors[static_cast<std::size_t>(accessor)].count;
}

Result<std::span<const std::uint8_t>> bytes_of_view(const tinygltf::Model& model, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= model.bufferViews.size())
    return fail("buffer view " + std::to_string(index) + " is not in the file");
  const auto& view = model.bufferViews[static_cast<std::size_t>(index)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
    return fail("its buffer view has no buffer");
  const auto& bytes = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
    return fail("its buffer view reaches beyond its buffer");
  return std::span(bytes).subspan(view.byteOffset, view.byteLength);
}

}  // namespace dance
