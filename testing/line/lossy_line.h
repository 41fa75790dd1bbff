// An emulated line, each direction by itself: what the spec says, with the recorded lines that come
// on top of it; and the words that describe it on a command line.
//
// Units/frames: up is to the server, down is back. Delays of several traces add up.
// Ownership:    shares its traces, which are read-only.
// Threads:      none inside.
// Failure:      load_line() and load_trace() name the word, or the file, its line and the cure.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "testing/line/capacity_trace.h"
#include "testing/line/delay_trace.h"
#include "testing/line/lossy_spec.h"

namespace dance {

struct LossyWay {
  LossySpec spec = {};
  std::vector<std::shared_ptr<const DelayTrace>> delays = {};
  std::shared_ptr<const CapacityTrace> capacity = {};  // or none: as much as the spec's rate
  Duration offset = {};                                // where the traces begin
};

struct LossyLine {
  LossyWay up, down;
};

// What a small datagram takes that comes so long after the begin and meets nobody else and no
// chance; nothing while none passes.
std::optional<Duration> time_on(const LossyWay& way, Duration since_begin);

// One of the two.
struct RecordedTrace {
  std::shared_ptr<const DelayTrace> delay;
  std::shared_ptr<const CapacityTrace> capacity;
};

// Which kind it is, its first line tells: a number alone begins a capacity trace.
Result<RecordedTrace> parse_trace(std::string_view text);
// Plain text or xz.
Result<RecordedTrace> load_trace(const std::string& path);

struct LineWords {
  std::string link = {};                     // for both directions;
  std::string link_up = {}, link_down = {};  // these words count more
  std::vector<std::string> traces = {};      // files, for both directions;
  std::vector<std::string> traces_up = {}, traces_down = {};
  double offset_s = 0.0;

  bool is_perfect_line() const {
    return link.empty() && link_up.empty() && link_down.empty() && traces.empty() &&
           traces_up.empty() && traces_down.empty();
  }
};

Result<LossyLine> load_line(const LineWords& words);

}  // namespace dance
