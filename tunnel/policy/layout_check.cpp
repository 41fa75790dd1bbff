#include "tunnel/policy/layout_check.h"

#include <charconv>
#include <string>

namespace dance {
namespace {

constexpr std::size_t kFingerprintBytes = 8;

bool is_field_name(std::string_view text) {
  if (text.empty() || text.size() > 16) return false;
  for (const char c : text)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c >= '0' && c <= '9')))
      return false;
  return text[0] < '0' || text[0] > '9';
}

tl::unexpected<Error> wrong_layout(std::string_view word, const std::string& why) {
  return fail("layout: \"" + std::string(word.substr(0, 40)) + "\": " + why);
}

}  // namespace

const std::array<LayoutCheck::TypeName, 10> LayoutCheck::kTypes{{
    {"i8", Type::kI8, 1},
    {"i16", Type::kI16, 2},
    {"i32", Type::kI32, 4},
    {"i64", Type::kI64, 8},
    {"f32", Type::kF32, 4},
    {"f64", Type::kF64, 8},
    {"bool", Type::kBool, 1},
    {"string", Type::kString, 0},
    {"bytes", Type::kByte, 1},
    {"byte", Type::kByte, 1},
}};

std::size_t LayoutCheck::width_of(Type type) {
  for (const TypeName& known : kTypes)
    if (known.type == type) return known.bytes;
  return 0;
}

Result<LayoutCheck> LayoutCheck::parse(std::string_view layout) {
  LayoutCheck check;
  if (layout == "any") {
    check.is_any_ = true;
    return check;
  }
  for (std::string_view rest = layout;;) {
    const std::size_t comma = rest.find(',');
    if (auto added = check.add_field(rest.substr(0, comma)); !added)
      return tl::make_unexpected(added.error());
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  return check;
}

Result<void> LayoutCheck::add_field(std::string_view text) {
  Field field;
  std::string_view rest = text;
  if (const std::size_t colon = rest.find(':'); colon != std::string_view::npos) {
    const std::string_view name = rest.substr(0, colon);
    if (!is_field_name(name))
      return wrong_layout(text, "before the colon stands a name, 1 to 16 letters, digits and _");
    for (const Field& other : fields_)
      if (other.name == name) return wrong_layout(text, "this name was given to a field before it");
    [[maybe_unused]] const bool fits = field.name.assign(name);
    rest.remove_prefix(colon + 1);
  }
  const std::string_view type = rest.substr(0, rest.find('['));
  const TypeName* known = nullptr;
  for (const TypeName& candidate : kTypes)
    if (candidate.name == type) known = &candidate;
  if (!known)
    return wrong_layout(text,
                        "no such type; there are i8 i16 i32 i64 f32 f64 bool string bytes, or the "
                        "whole layout is \"any\"");
  field.type = known->type;
  rest.remove_prefix(type.size());
  while (!rest.empty()) {
    const std::size_t end = rest.find(']');
    if (rest[0] != '[' || end == std::string_view::npos)
      return wrong_layout(text, "behind the type stand only sizes in brackets, as f64[7]");
    if (auto added = add_dimension(field, text, rest.substr(1, end - 1)); !added) return added;
    rest.remove_prefix(end + 1);
  }
  if (!fields_.try_push(field))
    return wrong_layout(
        text, "more than " + std::to_string(kMaxFields) + " fields; join equal ones, as f64[7]");
  return {};
}

Result<void> LayoutCheck::add_dimension(Field& field, std::string_view text,
                                        std::string_view size) const {
  Dimension dimension;
  const char* const end = size.data() + size.size();
  const auto read = std::from_chars(size.data(), end, dimension.value);
  if (read.ec != std::errc() || read.ptr != end) {
    dimension.is_field = true;
    dimension.value = kMaxFields;
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (!size.empty() && fields_[i].name == size) dimension.value = static_cast<std::uint32_t>(i);
    if (dimension.value == kMaxFields)
      return wrong_layout(text,
                          "the size in brackets is a number, or the name of a field before it, "
                          "as n:i32,f64[n]");
    const Field& count = fields_[dimension.value];
    if (!is_integer(count.type) || !count.dimensions.empty())
      return wrong_layout(text, "its size must be one integer: i8, i16, i32 or i64");
  } else if (dimension.value == 0 || dimension.value > kMaxCheckedBytes) {
    return wrong_layout(text, "a size is 1 to " + std::to_string(kMaxCheckedBytes));
  }
  if (!field.dimensions.try_push(dimension))
    return wrong_layout(text, "at most " + std::to_string(kMaxDimensions) + " sizes in brackets");
  return {};
}

// Where in the bytes we are.
struct LayoutCheck::Walk {
  std::span<const std::uint8_t> left;

  bool skip(std::size_t count) {
    if (count > left.size()) return false;
    left = left.subspan(count);
    return true;
  }
  // Two's complement, as wide as `width` says; there must be as many bytes.
  std::int64_t integer(std::size_t width) const {
    std::uint64_t value = left[0] >= 0x80 ? ~std::uint64_t{0} : 0;
    for (std::size_t i = 0; i < width; ++i) value = value << 8 | left[i];
    return static_cast<std::int64_t>(value);
  }
  bool skip_string() {
    if (left.size() < 4) return false;
    const std::int64_t size = integer(4);  // with the 0 at the end
    left = left.subspan(4);
    if (size < 1 || size > static_cast<std::int64_t>(left.size())) return false;
    const auto text = left.first(static_cast<std::size_t>(size));
    // A 0 before the end: languages would not agree where the text ends.
    for (std::size_t i = 0; i < text.size(); ++i)
      if ((text[i] == 0) != (i + 1 == text.size())) return false;
    left = left.subspan(text.size());
    return true;
  }
};

bool LayoutCheck::accepts(std::span<const std::uint8_t> bytes) const {
  if (bytes.size() > kMaxCheckedBytes) return false;
  Walk walk{bytes};
  if (fingerprint_ || !is_any_) {
    if (bytes.size() < kFingerprintBytes) return false;
    if (fingerprint_ &&
        static_cast<std::uint64_t>(walk.integer(kFingerprintBytes)) != *fingerprint_)
      return false;
    walk.skip(kFingerprintBytes);
  }
  if (is_any_) return true;
  std::array<std::int64_t, kMaxFields> integers{};
  for (std::size_t at = 0; at < fields_.size(); ++at) {
    const Field& field = fields_[at];
    const std::size_t width = width_of(field.type);
    // No partial product may be more than the bytes: with an inner count of 0 the outer one would
    // cost nothing here, and a generated decoder would make as many empty rows.
    std::size_t count = 1;
    bool is_empty = false;
    for (const Dimension& dimension : field.dimensions) {
      const std::int64_t size =
          dimension.is_field ? integers[dimension.value] : std::int64_t{dimension.value};
      if (size < 0 || size > static_cast<std::int64_t>(bytes.size())) return false;
      if (size == 0) is_empty = true;
      if (size > 0) count *= static_cast<std::size_t>(size);
      if (count > bytes.size()) return false;
    }
    if (is_empty) continue;
    if (field.type == Type::kString) {
      for (std::size_t i = 0; i < count; ++i)
        if (!walk.skip_string()) return false;
      continue;
    }
    if (count * width > walk.left.size()) return false;
    if (is_integer(field.type) && field.dimensions.empty()) integers[at] = walk.integer(width);
    if (field.type == Type::kBool)
      for (const std::uint8_t value : walk.left.first(count))
        if (value > 1) return false;
    walk.skip(count * width);
  }
  return walk.left.empty();
}

}  // namespace dance
