// A line's notation (first byte even) or a recorded trace of either kind (odd), as somebody may
// write it.
#include <string_view>

#include "core/base/assert.h"
#include "core/program/whole_file.h"
#include "testing/line/lossy_model.h"
#include "testing/line/trace_file.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(lossy) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  const dance::MonoTime begin = dance::MonoTime::from_us(1);
  if (data[0] % 2 == 0) {
    const auto spec = dance::LossySpec::parse(text);
    if (!spec) return 0;
    dance::LossyModel line({.spec = *spec}, 0);
    for (int i = 0; i < 50; ++i) {
      const dance::MonoTime now = begin + dance::Duration::ms(i);
      const auto fate = line.offer(1200, now);
      for (const dance::MonoTime due : fate.deliveries()) DANCE_ASSERT(due >= now);
    }
  } else {
    const auto text_or_xz = dance::unpacked(std::string(text), dance::kMostTraceBytes);
    if (!text_or_xz) return 0;
    const auto trace = dance::parse_trace(*text_or_xz);
    if (!trace) return 0;
    dance::LossyWay way;
    if (trace->delay) {
      for (int i = 0; i < 50; ++i) {
        const auto& point = trace->delay->at(dance::Duration::ms(37 * i));
        DANCE_ASSERT(point.delay >= dance::Duration() && point.loss >= 0.0f && point.loss <= 1.0f);
      }
      way.delays.push_back(trace->delay);
    }
    way.capacity = trace->capacity;
    way.offset = dance::Duration::ms(data[0] * 11);
    dance::LossyModel line(way, 0);
    for (int i = 0; i < 50; ++i) {
      const dance::MonoTime now = begin + dance::Duration::us(1700 * i);
      const auto fate = line.offer(static_cast<std::size_t>(61 * i), now);
      for (const dance::MonoTime due : fate.deliveries())
        DANCE_ASSERT(due >= now && (!way.capacity || due - now <= way.spec.queue));
    }
  }
  return 0;
}
