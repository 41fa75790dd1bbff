// Writes FlatBuffers by hand, for networks so small that one sees through them.
//
// Ownership: values.
// Threads:   none inside.
// Failure:   none; what is made need not make sense.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace dance {

struct Flat {
  // A table's field is a number of so many bytes, or what stands elsewhere.
  struct Field {
    std::size_t width_bytes = 0;
    std::uint64_t value = 0;
    std::vector<Flat> elsewhere;  // one or none
  };
  enum class Kind { kTable, kNumbers, kTables } kind = Kind::kTable;
  std::map<std::size_t, Field> fields;
  std::size_t count = 0;  // of kNumbers
  std::vector<std::uint8_t> raw;
  std::vector<Flat> tables;

  Flat& u8(std::size_t field, std::uint8_t value) { return number(field, 1, value); }
  Flat& i32(std::size_t field, std::int32_t value) {
    return number(field, 4, static_cast<std::uint32_t>(value));
  }
  Flat& at(std::size_t field, Flat child) {
    fields[field] = {4, 0, {std::move(child)}};
    return *this;
  }
  Flat& number(std::size_t field, std::size_t width_bytes, std::uint64_t value) {
    fields[field] = {width_bytes, value, {}};
    return *this;
  }
};

inline Flat flat_bytes(std::vector<std::uint8_t> raw, std::size_t width_bytes = 1) {
  Flat flat;
  flat.kind = Flat::Kind::kNumbers;
  flat.count = raw.size() / width_bytes;
  flat.raw = std::move(raw);
  return flat;
}

inline Flat flat_numbers(const std::vector<int>& values) {
  std::vector<std::uint8_t> raw;
  for (const int value : values)
    for (int shift = 0; shift < 32; shift += 8)
      raw.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> shift));
  return flat_bytes(std::move(raw), 4);
}

inline Flat flat_text(const std::string& text) { return flat_bytes({text.begin(), text.end()}); }

inline Flat flat_tables(std::vector<Flat> tables) {
  Flat flat;
  flat.kind = Flat::Kind::kTables;
  flat.tables = std::move(tables);
  return flat;
}

class FlatWriter {
 public:
  static std::vector<std::uint8_t> write(const Flat& root) {
    FlatWriter writer;
    writer.put(0, 4);
    writer.patch(0, writer.place(root));
    return std::move(writer.bytes_);
  }

 private:
  void put(std::uint64_t value, std::size_t width_bytes) {
    for (std::size_t i = 0; i < width_bytes; ++i)
      bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  // The offset that stands at `from` leads to `to`.
  void patch(std::size_t from, std::size_t to) {
    for (std::size_t i = 0; i < 4; ++i)
      bytes_[from + i] = static_cast<std::uint8_t>((to - from) >> (8 * i));
  }
  std::size_t place(const Flat& flat) {
    while (bytes_.size() % 4 != 0) bytes_.push_back(0);
    if (flat.kind == Flat::Kind::kTable) return place_table(flat);
    const std::size_t at = bytes_.size();
    if (flat.kind == Flat::Kind::kNumbers) {
      put(flat.count, 4);
      bytes_.insert(bytes_.end(), flat.raw.begin(), flat.raw.end());
      return at;
    }
    put(flat.tables.size(), 4);
    for (std::size_t i = 0; i < flat.tables.size(); ++i) put(0, 4);
    for (std::size_t i = 0; i < flat.tables.size(); ++i)
      patch(at + 4 + 4 * i, place(flat.tables[i]));
    return at;
  }
  std::size_t place_table(const Flat& flat) {
    const std::size_t entries = flat.fields.empty() ? 0 : flat.fields.rbegin()->first + 1;
    const std::size_t vtable = bytes_.size();
    std::map<std::size_t, std::size_t> offsets;
    std::size_t end = 4;
    for (const auto& [number, field] : flat.fields) {
      offsets[number] = end;
      end += 4;
    }
    put(4 + 2 * entries, 2);
    put(end, 2);
    for (std::size_t i = 0; i < entries; ++i) put(offsets.count(i) ? offsets[i] : 0, 2);
    while (bytes_.size() % 4 != 0) bytes_.push_back(0);
    const std::size_t table = bytes_.size();
    put(table - vtable, 4);
    for (const auto& entry : flat.fields) put(entry.second.value, 4);
    for (const auto& entry : flat.fields)
      if (!entry.second.elsewhere.empty())
        patch(table + offsets[entry.first], place(entry.second.elsewhere.front()));
    return table;
  }

  std::vector<std::uint8_t> bytes_;
};

}  // namespace dance
