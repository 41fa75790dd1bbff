#include "viewer/feed/arrival_meter.h"

#include "core/base/sequence.h"

namespace dance {
namespace {
constexpr Duration kWindow = Duration::s(1);
// A larger gap is not a loss: the sender restarted, or the guest was away.
constexpr std::int32_t kLargestGap = 600;
}  // namespace

void ArrivalMeter::on_pose(std::uint32_t sequence, MonoTime heard, std::optional<Duration> age) {
  if (!window_start_.is_set()) window_start_ = heard;
  if (heard - window_start_ >= kWindow) end_window(heard);

  const std::int32_t ahead = sequence_ahead(newest_sequence_, sequence);
  if (!has_sequence_ || ahead > kLargestGap || ahead < -kLargestGap) {
    has_sequence_ = true;
    newest_sequence_ = sequence;
  } else if (ahead > 0) {
    lost_ += static_cast<std::uint64_t>(ahead - 1);
    newest_sequence_ = sequence;
  } else if (ahead < 0 && lost_ > 0) {
    --lost_;  // out of order, not lost
  }
  ++received_;
  ++in_window_;
  if (age) {
    ++aged_in_window_;
    age_sum_ += *age;
  }
}

void ArrivalMeter::end_window(MonoTime now) {
  figures_.arrival_hz =
      static_cast<float>(static_cast<double>(in_window_) / (now - window_start_).as_seconds());
  figures_.age_ms.reset();
  if (aged_in_window_ > 0)
    figures_.age_ms = static_cast<float>((age_sum_ / aged_in_window_).as_ms());
  figures_.loss_percent = static_cast<float>(100.0 * static_cast<double>(lost_) /
                                             static_cast<double>(lost_ + received_));
  window_start_ = now;
  in_window_ = aged_in_window_ = 0;
  age_sum_ = Duration();
}

}  // namespace dance
