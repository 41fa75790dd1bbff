// Whether bytes are an LCM message of a given layout, found by walking over them: fields in order,
// every count and every string within the bytes, and nothing left over. Messages of strangers pass
// here before any generated decoder sees them, as those believe the counts.
//
// Units/frames: big-endian, as LCM writes; 8 bytes of fingerprint stand in front of the fields.
// Ownership:    plain value; accepts() allocates nothing and takes time in proportion to the bytes.
// Threads:      none inside.
// Failure:      parse() names the word and the cure; accepts() is false for all that does not fit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/fixed_list.h"
#include "core/base/fixed_string.h"
#include "core/base/result.h"

namespace dance {

// Messages are shorter than this, and so is every count in them.
constexpr std::size_t kMaxCheckedBytes = 4096;

class LayoutCheck {
 public:
  static constexpr std::size_t kMaxFields = 32;
  static constexpr std::size_t kMaxDimensions = 3;

  // "any", or fields with commas between: `i64,f64[7]`, `n:i32,f64[n][3],string`. Types: i8 i16 i32
  // i64 f32 f64 bool (0 or 1) string bytes (LCM's byte). A dimension is a number or the name of an
  // integer field before it.
  static Result<LayoutCheck> parse(std::string_view layout);

  void require_fingerprint(std::uint64_t fingerprint) { fingerprint_ = fingerprint; }
  // Passes all bytes (of the fingerprint, where one is required).
  bool is_any() const { return is_any_; }
  bool accepts(std::span<const std::uint8_t> bytes) const;

 private:
  enum class Type : std::uint8_t { kI8, kI16, kI32, kI64, kF32, kF64, kBool, kString, kByte };
  struct TypeName {
    std::string_view name;
    Type type;
    std::size_t bytes;  // 0: it says so itself
  };
  struct Dimension {
    bool is_field = false;
    std::uint32_t value = 0;  // a constant, or which field
  };
  struct Field {
    Type type = Type::kI8;
    FixedString<16> name;
    FixedList<Dimension, kMaxDimensions> dimensions;
  };
  struct Walk;

  static const std::array<TypeName, 10> kTypes;
  static std::size_t width_of(Type type);
  static bool is_integer(Type type) { return type <= Type::kI64; }
  Result<void> add_field(std::string_view text);
  Result<void> add_dimension(Field& field, std::string_view text, std::string_view size) const;

  FixedList<Field, kMaxFields> fields_;
  std::optional<std::uint64_t> fingerprint_;
  bool is_any_ = false;
};

}  // namespace dance
