#include "testing/line/lossy_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/net/datagram_sink.h"

namespace dance {
namespace {

// A datagram that is held back waits this long beyond its time: enough for the next pose at 60 Hz
// to overtake it.
constexpr Duration kShortestHold = Duration::ms(20);
constexpr double kHoldSpread_ms = 20.0;

}  // namespace

LossyModel::LossyModel(LossyWay way, std::uint64_t stream)
    : way_(std::move(way)), random_(way_.spec.seed * 0x9e3779b97f4a7c15ULL + stream) {
  if (way_.capacity) capacity_.emplace(way_.capacity);
  // Mean stay in the bad state is `burst` datagrams, and the share of time there is `loss`:
  // loss = p / (p + r), burst = 1 / r.
  const LossySpec& spec = way_.spec;
  if (spec.loss >= 1.0) {
    is_bad_ = true;
    bad_to_good_ = 0.0;
  } else {
    bad_to_good_ = 1.0 / spec.burst;
    good_to_bad_ = std::min(1.0, spec.loss * bad_to_good_ / (1.0 - spec.loss));
  }
}

bool LossyModel::loses(MonoTime now) {
  bool is_lost = false;
  if (way_.spec.burst > 1.0) {
    is_bad_ = is_bad_ ? random_.uniform() >= bad_to_good_ : random_.uniform() < good_to_bad_;
    is_lost = is_bad_;
  } else {
    is_lost =
        (way_.spec.loss > 0.0 || way_.spec.tail > Duration()) && random_.uniform() < way_.spec.loss;
  }
  for (const auto& trace : way_.delays) {
    const float loss = trace->at(now - begin_ + way_.offset).loss;
    is_lost = is_lost || (loss > 0.0f && random_.uniform() < static_cast<double>(loss));
  }
  return is_lost;
}

// The sum of two exponential ones, each half as long.
Duration LossyModel::draw_tail() {
  if (way_.spec.tail <= Duration()) return {};
  const auto exponential = [&] { return -std::log(1.0 - random_.uniform()); };
  const double first = exponential();
  return Duration::seconds(way_.spec.tail.as_seconds() * 0.5 * (first + exponential()));
}

std::optional<MonoTime> LossyModel::leaves(std::size_t bytes, MonoTime now) {
  const LossySpec& spec = way_.spec;
  MonoTime leaves = now;
  if (spec.rate_bps > 0.0) {
    if (line_free_ - now > spec.queue) return std::nullopt;
    line_free_ = std::max(line_free_, now) +
                 Duration::seconds(static_cast<double>(bytes + kIpUdp_bytes) * 8.0 / spec.rate_bps);
    leaves = line_free_;
  }
  if (!capacity_) return leaves;
  const auto passed =
      capacity_->take(bytes + kIpUdp_bytes, leaves - begin_ + way_.offset, spec.queue);
  if (!passed) return std::nullopt;
  return begin_ + (*passed - way_.offset);
}

LossyModel::Fate LossyModel::offer(std::size_t bytes, MonoTime now) {
  if (!begin_.is_set()) begin_ = now;
  const LossySpec& spec = way_.spec;
  ++counters_.offered;
  Fate fate;
  // With a tail both are drawn for each datagram, so that lines which differ in one of them have
  // the other in common.
  const bool is_lost = loses(now);
  const Duration tail = draw_tail();
  if (is_lost) {
    ++counters_.lost;
    return fate;
  }
  const auto left = leaves(bytes, now);
  if (!left) {
    ++counters_.queue_dropped;
    return fate;
  }
  Duration delay = spec.delay;
  for (const auto& trace : way_.delays) delay += trace->at(now - begin_ + way_.offset).delay;
  if (spec.jitter > Duration())
    delay += Duration::ns(static_cast<std::int64_t>(random_.uniform(-1.0, 1.0) *
                                                    static_cast<double>(spec.jitter.count_ns())));
  MonoTime arrives = *left + std::max(delay, Duration()) + tail;
  if (spec.reorder > 0.0 && random_.uniform() < spec.reorder) {
    ++counters_.reordered;
    arrives += kShortestHold + Duration::seconds(random_.uniform() * kHoldSpread_ms * 1e-3);
  } else if (spec.tail > Duration()) {
    counters_.reordered += arrives < newest_arrival_ ? 1 : 0;
    newest_arrival_ = std::max(arrives, newest_arrival_);
  } else {
    arrives = newest_arrival_ = std::max(arrives, newest_arrival_);
  }
  ++counters_.forwarded;
  fate.times_[fate.count_++] = arrives;
  if (spec.duplicate > 0.0 && random_.uniform() < spec.duplicate) {
    ++counters_.duplicated;
    fate.times_[fate.count_++] = arrives + Duration::ms(1);
  }
  return fate;
}

}  // namespace dance
