// A list of bounded length with inline storage, as for the entries of a datagram.
//
// Ownership: holds its values; never allocates.
// Threads:   none inside; plain value.
// Failure:   try_push() on a full list is refused (false).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/assert.h"

namespace dance {

template <class T, std::size_t kCapacity>
class FixedList {
 public:
  [[nodiscard]] bool try_push(const T& value) {
    if (size_ == kCapacity) return false;
    values_[size_++] = value;
    return true;
  }
  void erase_at(std::size_t i) {
    DANCE_ASSERT(i < size_, i, size_);
    std::move(begin() + i + 1, end(), begin() + i);
    --size_;
  }
  // The first of this value, where there is one.
  void erase(const T& value) {
    const auto found = std::find(begin(), end(), value);
    if (found != end()) erase_at(static_cast<std::size_t>(found - begin()));
  }
  void clear() { size_ = 0; }
  bool contains(const T& value) const { return std::find(begin(), end(), value) != end(); }

  T& operator[](std::size_t i) {
    DANCE_ASSERT(i < size_, i, size_);
    return values_[i];
  }
  const T& operator[](std::size_t i) const {
    DANCE_ASSERT(i < size_, i, size_);
    return values_[i];
  }
  T* begin() { return values_.data(); }
  T* end() { return values_.data() + size_; }
  const T* begin() const { return values_.data(); }
  const T* end() const { return values_.data() + size_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool is_full() const { return size_ == kCapacity; }
  static constexpr std::size_t capacity() { return kCapacity; }

 private:
  std::array<T, kCapacity> values_{};
  std::size_t size_ = 0;
};

}  // namespace dance
