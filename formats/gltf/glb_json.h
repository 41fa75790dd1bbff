// Access to the JSON of glTF's extensions, in which a stranger may have put anything anywhere.
//
// Ownership: refers to the value that it was given.
// Threads:   none inside.
// Failure:   what is not there, or of another type, or not finite, is nullptr or nullopt.
#pragma once

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace dance {

inline const tinygltf::Value* member(const tinygltf::Value* value, const char* name) {
  return value && value->IsObject() && value->Has(name) ? &value->Get(name) : nullptr;
}

inline const tinygltf::Value* extension_of(const tinygltf::ExtensionMap& extensions,
                                           const char* name) {
  const auto found = extensions.find(name);
  return found != extensions.end() ? &found->second : nullptr;
}

inline std::size_t length_of(const tinygltf::Value* list) {
  return list && list->IsArray() ? list->ArrayLen() : 0;
}

inline const tinygltf::Value* item(const tinygltf::Value* list, std::size_t index) {
  return index < length_of(list) ? &list->Get(static_cast<int>(index)) : nullptr;
}

inline std::optional<double> number_of(const tinygltf::Value* value) {
  if (!value || !value->IsNumber()) return std::nullopt;
  const double number = value->GetNumberAsDouble();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

inline float float_of(const tinygltf::Value* value, float otherwise, float least, float most) {
  const auto number = number_of(value);
  if (!number) return otherwise;
  return static_cast<float>(
      std::min(std::max(*number, static_cast<double>(least)), static_cast<double>(most)));
}

// An index of something of which there are `count`.
inline std::optional<int> index_in(const tinygltf::Value* value, std::size_t count) {
  if (!value || !value->IsInt()) return std::nullopt;
  const int index = value->Get<int>();
  if (index < 0 || static_cast<std::size_t>(index) >= count) return std::nullopt;
  return index;
}

inline std::string text_of(const tinygltf::Value* value) {
  return value && value->IsString() ? value->Get<std::string>() : std::string();
}

// The same without a copy, of what may be long and is asked for often.
inline std::string_view text_in(const tinygltf::Value* value) {
  return value && value->IsString() ? std::string_view(value->Get<std::string>())
                                    : std::string_view();
}

inline bool is_true(const tinygltf::Value* value) {
  return value && value->IsBool() && value->Get<bool>();
}

template <std::size_t kCount>
std::optional<std::array<double, kCount>> numbers_of(const tinygltf::Value* list) {
  std::array<double, kCount> numbers{};
  if (length_of(list) < kCount) return std::nullopt;
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto number = number_of(item(list, i));
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

}  // namespace dance
