#include "tests/allocation_guard.h"

#include <cerrno>
#include <cstddef>

namespace {

// Constant-initialised and trivial: malloc runs before any constructor of ours.
constinit thread_local std::uint64_t allocation_count = 0;

}  // namespace

namespace dance {

std::uint64_t AllocationGuard::allocated_by_this_thread() { return allocation_count; }

}  // namespace dance

#ifndef DANCE_SANITIZED

// glibc lets a program define the malloc family; its own stays reachable under these names. The
// library's operator new calls malloc, so that this alone sees everything.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) {
  ++allocation_count;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocation_count;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++allocation_count;
  return __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  ++allocation_count;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocation_count;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  ++allocation_count;
  if (alignment < sizeof(void*) || (alignment & (alignment - 1)) != 0) return EINVAL;
  void* memory = __libc_memalign(alignment, size);
  if (memory == nullptr) return ENOMEM;
  *block = memory;
  return 0;
}
void free(void* block) { __libc_free(block); }
}

#else

// A sanitizer brings its own malloc and operator new, and calls this after each allocation.
extern "C" void __sanitizer_malloc_hook(const volatile void*, std::size_t);
extern "C" void __sanitizer_malloc_hook(const volatile void*, std::size_t) { ++allocation_count; }

#endif
