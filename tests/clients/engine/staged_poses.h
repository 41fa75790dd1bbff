// StagedPoses: what a house staged while a client read it, as heard on the bus: where the bones of
// each pose are. A client's lines are compared with it by guest and sequence.
//
// Units/frames: W, metres; a client's places come in its own axes and units.
// Ownership:    the bus subscription refers to it: it outlives the bus.
// Threads:      one.
// Failure:      a line that cannot be read, and a pose that was not heard here, are counted.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "consumers/engine/dance_adapter.h"
#include "core/bus/bus.h"
#include "core/pose/kinematics.h"

namespace dance {

struct StagedPoseComparison {
  std::map<std::string, int> poses;              // compared, of each guest
  std::map<std::string, int> poses_after;        // of these, those staged after mark()
  int unheard = 0;                               // not heard here, as the bus may lose some
  int unreadable = 0;                            // lines
  double furthest_mm = 0.0;                      // of a bone from where the stage had it
  std::array<unsigned long long, 5> counters{};  // reads, retries, busy, damaged, attached
  bool has_counters = false;
  int collections = -1;  // of a garbage collector, where the client has one
};

class StagedPoses {
 public:
  explicit StagedPoses(Bus& bus);
  // All that was staged up to now is before the mark.
  void mark();
  std::size_t size() const { return staged_.size(); }
  bool has_skeletons_of(std::size_t guests) const { return skeletons_.size() >= guests; }
  StagedPoseComparison compare(const std::string& client_output, dance_axes axes) const;

 private:
  using Places = std::array<Eigen::Vector3f, kBoneCount>;
  bool compare_pose(const std::string& line, dance_axes axes,
                    StagedPoseComparison& comparison) const;

  std::map<std::string, Skeleton> skeletons_;
  std::map<std::pair<std::string, std::uint32_t>, Places> staged_;
  std::map<std::string, std::uint32_t> newest_, marked_;
};

}  // namespace dance
