// BeatModel: a beat tracker's parameters, trained on songs whose beats are known: a recurrent
// network that hears beats and the tempo of steps, and rhythm patterns.
// `dance music train` makes one; data/music/beats.model is built in.
//
// Units/frames: as in net/rhythm_net.h and meter_pattern.h.
// Ownership:    a value that many trackers may share.
// Threads:      none inside; const calls may run at the same time.
// Failure:      read_beat_model names what is wrong with a file; what it accepts is finite and
//               within bounds.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "producers/music/tracker/meter_pattern.h"
#include "producers/music/tracker/net/rhythm_net.h"

namespace dance {

struct BeatModel {
  static constexpr std::size_t kMostPatterns = 32;

  RhythmNet net;
  std::vector<MeterPattern> patterns;  // at least one
  std::uint32_t name = 0;              // of the file it was read from
};

std::vector<std::uint8_t> write_beat_model(const BeatModel& model);
Result<std::shared_ptr<const BeatModel>> read_beat_model(std::span<const std::uint8_t> file);
std::shared_ptr<const BeatModel> built_in_beat_model();

}  // namespace dance
