// The structs of dance_adapter.h as callers hand them in: each begins with its size as the caller
// knows it.
//
// Ownership: the caller's memory.
// Threads:   none inside.
// Failure:   fits() is false for NULL and for a size that no version of the struct has, as that of
//            a struct that was not set up.
#pragma once

#include <cstdint>
#include <cstring>

namespace dance::engine {

constexpr std::uint32_t kLargestStruct_bytes = 4096;

template <class T>
bool fits(const T* theirs) {
  return theirs && theirs->struct_size >= sizeof(T) && theirs->struct_size <= kLargestStruct_bytes;
}

// What a caller of a later version has at the end, and this library does not know.
template <class T>
void clear_unknown(T* theirs) {
  std::memset(reinterpret_cast<unsigned char*>(theirs) + sizeof(T), 0,
              theirs->struct_size - sizeof(T));
}

}  // namespace dance::engine
