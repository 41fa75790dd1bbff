// How many poses a guest sends of late, and how many bytes of them.
//
// Units/frames: a second; bytes of records.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cstddef>
#include <cstdint>

namespace dance {

class PoseFlow {
 public:
  void add(std::size_t bytes) {
    ++poses_;
    bytes_ += bytes;
  }
  // The `seconds` since the last time are over; the newest count half.
  void sample(double seconds) {
    const double blend = is_known_ ? 0.5 : 1.0;
    is_known_ = is_known_ || poses_ > 0;
    poses_per_s_ += (static_cast<double>(poses_) / seconds - poses_per_s_) * blend;
    bytes_per_s_ += (static_cast<double>(bytes_) / seconds - bytes_per_s_) * blend;
    poses_ = bytes_ = 0;
  }
  double poses_per_s() const { return poses_per_s_; }
  double bytes_per_s() const { return bytes_per_s_; }

 private:
  bool is_known_ = false;
  std::uint64_t poses_ = 0, bytes_ = 0;
  double poses_per_s_ = 0.0, bytes_per_s_ = 0.0;
};

}  // namespace dance
