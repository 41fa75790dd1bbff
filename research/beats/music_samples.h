// A song as samples, and the same song as a record that turns faster.
//
// Units/frames: mono samples at the file's rate.
// Ownership:    plain values.
// Threads:      one.
// Failure:      an Error names the file that cannot be read, or whose rate the tracker cannot take.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

struct MusicSamples {
  double rate_hz = 0.0;
  std::vector<float> samples;
};

// What samples are multiplied by.
float gain_of_db(double db);

Result<MusicSamples> read_music_samples(const std::string& path);
std::vector<float> turned(const std::vector<float>& samples, double speed, double from = 0.0);

}  // namespace dance
