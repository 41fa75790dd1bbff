// LossWords: one line when a tracked point has been gone for long, and one when it is back.
//
// Units/frames: a bit for each TrackedPoint.
// Ownership:    plain value.
// Threads:      none inside; one owner, which may write.
// Failure:      none.
#pragma once

#include <cstdint>

namespace dance {

class LossWords {
 public:
  void tell(std::uint32_t lost);

 private:
  std::uint32_t told_ = 0;
};

}  // namespace dance
