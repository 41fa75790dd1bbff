// CacheAligned: an allocator for numbers that are read by wide vectors: blocks begin with a cache
// line, so that no vector lies across two.
//
// Ownership: as std::allocator.
// Threads:   any.
// Failure:   std::bad_alloc.
#pragma once

#include <cstddef>
#include <new>

namespace dance {

template <class T>
struct CacheAligned {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  CacheAligned() = default;
  template <class U>
  CacheAligned(const CacheAligned<U>&) {}

  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kLine)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, kLine); }
  friend bool operator==(const CacheAligned&, const CacheAligned&) { return true; }
};

}  // namespace dance
