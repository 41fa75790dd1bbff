#include "tests/core/bus/tap.h"

#include <testlcm/tap_t.hpp>

#include "core/bus/message_fields.h"

namespace dance {

template <>
struct MessageFields<Tap> {
  using Generated = testlcm::tap_t;
  static bool map(auto io, auto& m, auto& v) {
    return io(m.time_us, v.time) && io(m.clock_id, v.clock_id) && io(m.count, v.count) &&
           io(m.force_n, v.force_n) && io(m.foot, v.foot);
  }
};
template struct MessageRow<Tap, Signal::kStyle>;

}  // namespace dance
