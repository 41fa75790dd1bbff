// How the fields of a generated LCM type are those of one of this tree's types, named once for both
// directions. The rows are in encode.cpp; only files of this folder and tests may include this one.
//
// Units/frames: microseconds on the bus; rotations xyzw.
// Ownership:    allocates nothing.
// Threads:      none inside.
// Failure:      a field that cannot be read (a time out of range, text that is not ended, a name by
//               no rule) makes the whole message Decoded::kInvalid.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string_view>
#include <type_traits>

#include "core/base/assert.h"
#include "core/base/time.h"
#include "core/bus/encode.h"

namespace dance {

// Which fields of the generated type are which of T, for PutFields and GetFields both:
//   using Generated = dancelcm::name_t;
//   template <class Io, class Message, class Value>
//   static bool map(Io io, Message& m, Value& v) { return io(m.time_us, v.time) && …; }
// and, where bits of it may mean nothing here,
//   static void mask(T& v);
template <class T>
struct MessageFields;

// A time that can be computed with: within 100 years of its clock's zero.
inline bool is_time(std::int64_t us) {
  constexpr std::int64_t kCentury_us = 100LL * 366 * 24 * 3600 * 1'000'000;
  return us > -kCentury_us && us < kCentury_us;
}

// From our values to the fields of a message; always true.
struct PutFields {
  bool operator()(std::int64_t& us, MonoTime time) const {
    us = time.since_zero_us();
    return true;
  }
  bool operator()(std::int64_t& us, Duration duration) const {
    us = duration.count_us();
    return true;
  }
  template <class Field, class Value>
  requires std::is_arithmetic_v<Value>
  bool operator()(Field& field, Value value) const {
    field = static_cast<Field>(value);
    return true;
  }
  template <class Field, class Value>
  requires std::is_enum_v<Value>
  bool operator()(Field& field, Value value) const {
    field = static_cast<Field>(value);
    return true;
  }
  bool operator()(float (&xyzw)[4], const Eigen::Quaternionf& q) const {
    for (int i = 0; i < 4; ++i) xyzw[i] = q.coeffs()[i];
    return true;
  }
  bool operator()(float (&field)[3], const Eigen::Vector3f& v) const {
    for (int i = 0; i < 3; ++i) field[i] = v[i];
    return true;
  }
  template <class Field, class Value, std::size_t kCount>
  bool operator()(Field (&fields)[kCount], const std::array<Value, kCount>& values) const {
    for (std::size_t i = 0; i < kCount; ++i) (*this)(fields[i], values[i]);
    return true;
  }
  // Text and names, zeros to the end.
  template <std::size_t kBytes, class Text>
  requires requires(const Text& text) { text.view(); }
  bool operator()(std::uint8_t (&bytes)[kBytes], const Text& text) const {
    const std::string_view view = text.view();
    DANCE_ASSERT(view.size() < kBytes, view.size());
    std::fill(std::copy(view.begin(), view.end(), bytes), std::end(bytes), std::uint8_t{0});
    return true;
  }
};

// From the fields of a message to our values; false for what no value of ours can be.
struct GetFields {
  bool operator()(std::int64_t us, MonoTime& time) const {
    time = MonoTime::from_us(is_time(us) ? us : 0);
    return is_time(us);
  }
  bool operator()(std::int64_t us, Duration& duration) const {
    duration = Duration::us(is_time(us) ? us : 0);
    return is_time(us);
  }
  template <class Field, class Value>
  requires std::is_arithmetic_v<Value>
  bool operator()(Field field, Value& value) const {
    if constexpr (std::is_same_v<Value, bool>)
      value = field != 0;
    else
      value = static_cast<Value>(field);
    return true;
  }
  template <class Field, class Value>
  requires std::is_enum_v<Value>
  bool operator()(Field field, Value& value) const {
    value = static_cast<Value>(field);
    return true;
  }
  bool operator()(const float (&xyzw)[4], Eigen::Quaternionf& q) const {
    q = Eigen::Quaternionf(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    return true;
  }
  bool operator()(const float (&field)[3], Eigen::Vector3f& v) const {
    v = {field[0], field[1], field[2]};
    return true;
  }
  template <class Field, class Value, std::size_t kCount>
  bool operator()(const Field (&fields)[kCount], std::array<Value, kCount>& values) const {
    for (std::size_t i = 0; i < kCount; ++i)
      if (!(*this)(fields[i], values[i])) return false;
    return true;
  }
  template <std::size_t kBytes, std::size_t kCapacity>
  bool operator()(const std::uint8_t (&bytes)[kBytes], FixedString<kCapacity>& text) const {
    const auto found = text_in(bytes);
    return found && text.assign(*found);
  }
  // A name, or none.
  template <std::size_t kBytes>
  bool operator()(const std::uint8_t (&bytes)[kBytes], GuestId& name) const {
    const auto text = text_in(bytes);
    if (!text) return false;
    const auto parsed = GuestId::parse(*text);
    name = parsed.value_or(GuestId());
    return parsed || text->empty();
  }

 private:
  // What stands before the first 0; nullopt where there is none, or something stands behind it.
  template <std::size_t kBytes>
  static std::optional<std::string_view> text_in(const std::uint8_t (&bytes)[kBytes]) {
    const auto* const end = std::find(std::begin(bytes), std::end(bytes), std::uint8_t{0});
    if (end == std::end(bytes)) return std::nullopt;
    if (std::any_of(end, std::end(bytes), [](std::uint8_t byte) { return byte != 0; }))
      return std::nullopt;
    return std::string_view(reinterpret_cast<const char*>(bytes),
                            static_cast<std::size_t>(end - std::begin(bytes)));
  }
};

template <class Generated>
std::size_t pack(const Generated& message, MessageBuffer& buffer) {
  const int size = message.encode(buffer.data(), 0, static_cast<int>(buffer.size()));
  DANCE_ASSERT(size > 0, size);
  return static_cast<std::size_t>(size);
}

template <class Generated>
bool unpack(const void* data, std::size_t size, Generated& message) {
  // Ours have one size each: another length is another type's.
  return size <= kMaxMessageBytes &&
         message.decode(data, 0, static_cast<int>(size)) == static_cast<int>(size);
}

template <class T, Signal kOfSignal>
std::string_view MessageRow<T, kOfSignal>::type_name() {
  return MessageFields<T>::Generated::getTypeName();
}

template <class T, Signal kOfSignal>
std::uint64_t MessageRow<T, kOfSignal>::fingerprint() {
  return static_cast<std::uint64_t>(MessageFields<T>::Generated::getHash());
}

template <class T, Signal kOfSignal>
std::size_t MessageRow<T, kOfSignal>::encode(const T& message, MessageBuffer& buffer) {
  typename MessageFields<T>::Generated m{};
  MessageFields<T>::map(PutFields(), m, message);
  return pack(m, buffer);
}

template <class T, Signal kOfSignal>
Decoded MessageRow<T, kOfSignal>::decode(const void* data, std::size_t size, T& message) {
  typename MessageFields<T>::Generated m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  T read;
  if (!MessageFields<T>::map(GetFields(), m, read)) return Decoded::kInvalid;
  if constexpr (requires { MessageFields<T>::mask(read); }) MessageFields<T>::mask(read);
  if (!is_valid(read)) return Decoded::kInvalid;
  if constexpr (requires { normalize(read); }) normalize(read);
  message = read;
  return Decoded::kFine;
}

}  // namespace dance
