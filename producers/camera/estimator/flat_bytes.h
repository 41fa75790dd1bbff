// Reads FlatBuffers, the format that .tflite files are written in: tables that name their fields by
// number, vectors, text.
//
// Units/frames: little-endian; places are offsets from the file's first byte.
// Ownership:    looks at the caller's bytes, which must outlive what is read of them.
// Threads:      none inside.
// Failure:      a read that would leave the file sets the file's flag and gives 0, an absent table
//               or an empty vector; ok() is then false and stays so. Nothing is allocated.
// Source:       the FlatBuffers binary format (internals page of its documentation).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace dance {

class FlatBytes {
 public:
  explicit FlatBytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  std::size_t size() const { return bytes_.size(); }
  void set_wrong() { ok_ = false; }

  std::uint64_t number(std::size_t at, std::size_t width_bytes) {
    if (!holds(at, width_bytes)) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < width_bytes; ++i)
      value |= static_cast<std::uint64_t>(bytes_[at + i]) << (8 * i);
    return value;
  }
  std::uint16_t u16(std::size_t at) { return static_cast<std::uint16_t>(number(at, 2)); }
  std::uint32_t u32(std::size_t at) { return static_cast<std::uint32_t>(number(at, 4)); }
  std::int32_t i32(std::size_t at) { return std::bit_cast<std::int32_t>(u32(at)); }

  std::span<const std::uint8_t> bytes(std::size_t at, std::size_t count) {
    if (!holds(at, count)) return {};
    return bytes_.subspan(at, count);
  }

 private:
  bool holds(std::size_t at, std::size_t count) {
    if (at <= bytes_.size() && count <= bytes_.size() - at) return ok_;
    ok_ = false;
    return false;
  }

  std::span<const std::uint8_t> bytes_;
  bool ok_ = true;
};

// `count` elements of `width_bytes` each from `at`; a place in the file, checked when it is made.
struct FlatVector {
  FlatBytes* file = nullptr;
  std::size_t at = 0;
  std::size_t count = 0;
  std::size_t width_bytes = 1;

  std::uint64_t number(std::size_t i) const {
    return i < count ? file->number(at + i * width_bytes, width_bytes) : 0;
  }
  std::int32_t i32(std::size_t i) const { return i < count ? file->i32(at + 4 * i) : 0; }
  std::span<const std::uint8_t> bytes() const {
    return count == 0 ? std::span<const std::uint8_t>{} : file->bytes(at, count * width_bytes);
  }
};

class FlatTable {
 public:
  FlatTable() = default;
  FlatTable(FlatBytes& file, std::size_t at) : file_(&file), at_(at) {
    const std::int64_t vtable = static_cast<std::int64_t>(at) - file.i32(at);
    if (!file.ok() || vtable < 0 || static_cast<std::uint64_t>(vtable) >= file.size()) {
      file.set_wrong();
      return;
    }
    vtable_ = static_cast<std::size_t>(vtable);
    vtable_bytes_ = file.u16(vtable_);
    is_there_ = file.ok();
  }
  static FlatTable root(FlatBytes& file) { return FlatTable(file, file.u32(0)); }

  bool is_there() const { return is_there_; }
  // The field as the schema's integer; `absent` where the writer left it out.
  std::int32_t i32(std::size_t field, std::int32_t absent = 0) const {
    const std::size_t at = place(field);
    return at == 0 ? absent : file_->i32(at);
  }
  std::uint32_t u32(std::size_t field) const {
    const std::size_t at = place(field);
    return at == 0 ? 0 : file_->u32(at);
  }
  std::uint8_t u8(std::size_t field) const {
    const std::size_t at = place(field);
    return at == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(file_->number(at, 1));
  }
  FlatTable table(std::size_t field) const {
    const std::size_t at = place(field);
    return at == 0 ? FlatTable{} : FlatTable(*file_, at + file_->u32(at));
  }
  // Empty where it is absent.
  FlatVector vector(std::size_t field, std::size_t width_bytes) const {
    const std::size_t at = place(field);
    if (at == 0) return {};
    const std::size_t start = at + file_->u32(at);
    const std::size_t count = file_->u32(start);
    if (!file_->ok() || count > (file_->size() - start - 4) / width_bytes) {
      file_->set_wrong();
      return {};
    }
    return {file_, start + 4, count, width_bytes};
  }
  FlatTable table_of(const FlatVector& tables, std::size_t i) const {
    const std::size_t at = tables.at + 4 * i;
    return i < tables.count ? FlatTable(*file_, at + file_->u32(at)) : FlatTable{};
  }
  std::string_view text(std::size_t field) const {
    const auto b = vector(field, 1).bytes();
    return {reinterpret_cast<const char*>(b.data()), b.size()};
  }

 private:
  // 0 where the field is absent: no field of a table lies there.
  std::size_t place(std::size_t field) const {
    const std::size_t entry = 4 + 2 * field;
    if (!is_there_ || entry + 2 > vtable_bytes_) return 0;
    const std::uint16_t offset = file_->u16(vtable_ + entry);
    return offset == 0 ? 0 : at_ + offset;
  }

  FlatBytes* file_ = nullptr;
  std::size_t at_ = 0;
  std::size_t vtable_ = 0;
  std::size_t vtable_bytes_ = 0;
  bool is_there_ = false;
};

}  // namespace dance
