// The questions of `dance bench voice`, each with its baseline: what Opus costs and bears, how much
// of a voice is made up over recorded lines, how much of an echo is left, and how long a voice
// takes from one mouth to another's ear.
//
// Units/frames: milliseconds, decibels, percent; speech as mono samples at 48 kHz.
// Ownership:    plain values.
// Threads:      one.
// Failure:      names what is missing and the cure.
#pragma once

#include <ctime>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

using Speech = std::vector<float>;

// Of this process so far.
inline double cpu_us() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

struct BenchReport {
  std::string text;
  nlohmann::ordered_json json;
};

Result<BenchReport> bench_voice_codec(const Speech& speech);
// Each of `traces` is a recorded line; `links` are described ones.
Result<BenchReport> bench_voice_lines(const Speech& speech, const std::vector<std::string>& traces,
                                      const std::vector<std::string>& links);
Result<BenchReport> bench_voice_echo(const Speech& near, const Speech& far);
// Real programs, a server, a sound server: call while the process has one thread.
Result<BenchReport> bench_voice_ear(const Speech& speech, const std::string& folder);
Result<BenchReport> bench_voice_room(const Speech& speech, const std::string& folder);

}  // namespace dance
