// Counts what the calling thread allocates, so that a test can prove that a piece of code allocates
// nothing. Linking dance_allocation_guard into a test replaces the program's allocation functions
// by counting ones.
//
// Ownership: counts only; memory comes from the C library as ever.
// Threads:   each thread counts its own; what another thread allocates meanwhile does not show.
// Failure:   none. In the plain build the malloc family of glibc is replaced, which operator new,
//            Eigen and C libraries all end in; under address and thread sanitizers their allocation
//            hook counts instead.
#pragma once

#include <cstdint>

namespace dance {

class AllocationGuard {
 public:
  AllocationGuard() : at_start_(allocated_by_this_thread()) {}
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  // Allocations of this thread since the guard was made; a reallocation counts as one, a release as
  // none.
  std::uint64_t allocations() const { return allocated_by_this_thread() - at_start_; }

 private:
  static std::uint64_t allocated_by_this_thread();

  std::uint64_t at_start_;
};

}  // namespace dance
