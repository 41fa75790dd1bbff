// AdapterReader: an engine's side of the benchmark: reads all dancers of a house through the C
// functions that an engine calls.
//
// Units/frames: as dance_adapter.h.
// Ownership:    owns the handle.
// Threads:      one owner.
// Failure:      torn poses are counted; see() is false until all dancers are there.
#pragma once

#include <array>
#include <string>

#include "bench/adapter/numbered_dance.h"
#include "core/base/time.h"

namespace dance {

class AdapterReader {
 public:
  explicit AdapterReader(const std::string& name)
      : adapter_(dance_adapter_open(name.c_str(), DANCE_AXES_GLTF)) {}
  ~AdapterReader() { dance_adapter_close(adapter_); }
  AdapterReader(const AdapterReader&) = delete;
  AdapterReader& operator=(const AdapterReader&) = delete;

  // Whether that many dancers are there.
  bool see(std::size_t wanted) {
    guests_[0].struct_size = sizeof(dance_guest);
    count_ = dance_adapter_guests(adapter_, guests_.data(), DANCE_MAX_GUESTS);
    return count_ == wanted;
  }
  std::size_t count() const { return count_; }

  dance_status newest(std::size_t dancer) {
    dance_pose& pose = prepared(dancer);
    const dance_status status = dance_adapter_newest(adapter_, guests_[dancer].slot, &pose);
    if (status == DANCE_OK && is_torn(pose)) ++torn_;
    return status;
  }
  void read_newest() {
    for (std::size_t i = 0; i < count_; ++i)
      dance_adapter_newest(adapter_, guests_[i].slot, &prepared(i));
  }
  void read_at(MonoTime t) {
    for (std::size_t i = 0; i < count_; ++i)
      dance_adapter_at(adapter_, guests_[i].slot, t.since_zero_ns(), &prepared(i));
  }
  void check() {
    for (std::size_t i = 0; i < count_; ++i) torn_ += is_torn(poses_[i]);
  }

  const dance_pose& pose(std::size_t dancer) const { return poses_[dancer]; }
  const void* bytes() const { return poses_.data(); }
  std::size_t byte_count() const { return count_ * sizeof(dance_pose); }
  std::uint64_t torn() const { return torn_; }
  dance_counters counters() const {
    dance_counters counters{};
    counters.struct_size = sizeof counters;
    dance_adapter_counters(adapter_, &counters);
    return counters;
  }

 private:
  dance_pose& prepared(std::size_t dancer) {
    poses_[dancer].struct_size = sizeof(dance_pose);
    return poses_[dancer];
  }

  dance_adapter* adapter_;
  std::array<dance_guest, DANCE_MAX_GUESTS> guests_{};
  std::array<dance_pose, DANCE_MAX_GUESTS> poses_{};
  std::size_t count_ = 0;
  std::uint64_t torn_ = 0;
};

}  // namespace dance
