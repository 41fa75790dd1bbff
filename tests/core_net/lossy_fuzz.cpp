// A line's notation (first byte even) or a recorded trace (odd), as somebody may write it.
#include <string_view>

#include "core/base/assert.h"
#include "core/net/delay_trace.h"
#include "core/net/lossy_model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  const dance::MonoTime begin = dance::MonoTime::from_us(1);
  if (data[0] % 2 == 0) {
    const auto spec = dance::LossySpec::parse(text);
    if (!spec) return 0;
    dance::LossyModel line(*spec, nullptr, 0);
    for (int i = 0; i < 50; ++i) {
      const dance::MonoTime now = begin + dance::Duration::ms(i);
      const auto fate = line.offer(1200, now);
      for (const dance::MonoTime due : fate.deliveries()) DANCE_ASSERT(due >= now);
    }
  } else {
    const auto trace = dance::DelayTrace::parse(text);
    if (!trace) return 0;
    for (int i = 0; i < 50; ++i) {
      const auto& point = trace->at(dance::Duration::ms(37 * i));
      DANCE_ASSERT(point.delay >= dance::Duration() && point.loss >= 0.0f && point.loss <= 1.0f);
    }
  }
  return 0;
}
