#include "core/net/lossy_model.h"

#include <algorithm>

#include "core/net/datagram_sink.h"

namespace dance {
namespace {

// A datagram that is held back waits this long beyond its time: enough for the next pose at 60 Hz
// to overtake it.
constexpr Duration kShortestHold = Duration::ms(20);
constexpr double kHoldSpread_ms = 20.0;

}  // namespace

LossyModel::LossyModel(const LossySpec& spec, const DelayTrace* trace, std::uint64_t stream)
    : spec_(spec), trace_(trace), random_(spec.seed * 0x9e3779b97f4a7c15ULL + stream) {
  // Mean stay in the bad state is `burst` datagrams, and the share of time there is `loss`:
  // loss = p / (p + r), burst = 1 / r.
  if (spec.loss >= 1.0) {
    is_bad_ = true;
    bad_to_good_ = 0.0;
  } else {
    bad_to_good_ = 1.0 / spec.burst;
    good_to_bad_ = std::min(1.0, spec.loss * bad_to_good_ / (1.0 - spec.loss));
  }
}

bool LossyModel::loses() {
  if (spec_.burst <= 1.0) return spec_.loss > 0.0 && random_.uniform() < spec_.loss;
  is_bad_ = is_bad_ ? random_.uniform() >= bad_to_good_ : random_.uniform() < good_to_bad_;
  return is_bad_;
}

LossyModel::Fate LossyModel::offer(std::size_t bytes, MonoTime now) {
  if (!begin_.is_set()) begin_ = now;
  ++counters_.offered;
  Fate fate;
  if (loses()) {
    ++counters_.lost;
    return fate;
  }
  Duration delay = spec_.delay;
  if (trace_ != nullptr) {
    const DelayTrace::Point& point = trace_->at(now - begin_);
    if (point.loss > 0.0f && random_.uniform() < static_cast<double>(point.loss)) {
      ++counters_.lost;
      return fate;
    }
    delay += point.delay;
  }
  MonoTime leaves = now;
  if (spec_.rate_bps > 0.0) {
    if (line_free_ - now > spec_.queue) {
      ++counters_.queue_dropped;
      return fate;
    }
    line_free_ =
        std::max(line_free_, now) +
        Duration::seconds(static_cast<double>(bytes + kIpUdp_bytes) * 8.0 / spec_.rate_bps);
    leaves = line_free_;
  }
  if (spec_.jitter > Duration())
    delay += Duration::ns(static_cast<std::int64_t>(random_.uniform(-1.0, 1.0) *
                                                    static_cast<double>(spec_.jitter.count_ns())));
  MonoTime arrives = leaves + std::max(delay, Duration());
  if (spec_.reorder > 0.0 && random_.uniform() < spec_.reorder) {
    ++counters_.reordered;
    arrives += kShortestHold + Duration::seconds(random_.uniform() * kHoldSpread_ms * 1e-3);
  } else {
    arrives = newest_arrival_ = std::max(arrives, newest_arrival_);
  }
  ++counters_.forwarded;
  fate.times_[fate.count_++] = arrives;
  if (spec_.duplicate > 0.0 && random_.uniform() < spec_.duplicate) {
    ++counters_.duplicated;
    fate.times_[fate.count_++] = arrives + Duration::ms(1);
  }
  return fate;
}

}  // namespace dance
