#include "tests/allocation_guard.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

namespace dance {
namespace {

// Keeps the compiler from removing an allocation that nothing uses.
void keep(void* block) { asm volatile("" : : "g"(block) : "memory"); }

TEST(AllocationGuard, CountsEveryFormOfNew) {
  struct alignas(64) Wide {
    char bytes[64];
  };
  const AllocationGuard guard;
  const auto one = std::make_unique<int>(1);
  keep(one.get());
  EXPECT_EQ(guard.allocations(), 1u);
  const std::unique_ptr<int[]> array(new int[5]);
  keep(array.get());
  EXPECT_EQ(guard.allocations(), 2u);
  const std::unique_ptr<Wide> wide(new Wide);
  keep(wide.get());
  EXPECT_EQ(guard.allocations(), 3u);
  const std::unique_ptr<int> quiet(new (std::nothrow) int(3));
  keep(quiet.get());
  EXPECT_EQ(guard.allocations(), 4u);
}

TEST(AllocationGuard, CountsNothingWhereNothingIsAllocated) {
  std::vector<int> reserved;
  reserved.reserve(100);
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) reserved.push_back(i);
  keep(reserved.data());
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(AllocationGuard, SeesMallocOfEigenAndOfCLibraries) {
  const AllocationGuard guard;
  const Eigen::VectorXf dynamic = Eigen::VectorXf::Zero(1000);
  EXPECT_FLOAT_EQ(dynamic.sum(), 0.0f);
  EXPECT_GE(guard.allocations(), 1u);
  const std::uint64_t before = guard.allocations();
  void* block = std::malloc(10);
  keep(block);
  block = std::realloc(block, 100000);
  keep(block);
  std::free(block);
  EXPECT_EQ(guard.allocations(), before + 2);
}

TEST(AllocationGuard, LeavesOtherThreadsOut) {
  std::uint64_t of_other = 0;
  std::uint64_t of_this = 0;
  std::thread other;
  {
    std::atomic<bool> is_counting = false, is_done = false;
    other = std::thread([&] {
      while (!is_counting) std::this_thread::yield();
      const AllocationGuard guard;
      for (int i = 0; i < 10; ++i) keep(std::make_unique<int>(i).get());
      of_other = guard.allocations();
      is_done = true;
    });
    const AllocationGuard guard;
    is_counting = true;
    while (!is_done) std::this_thread::yield();
    of_this = guard.allocations();
    other.join();
  }
  EXPECT_EQ(of_other, 10u);
  EXPECT_EQ(of_this, 0u);
}

}  // namespace
}  // namespace dance
