#include "voice/playout/arrival_delays.h"

#include <algorithm>

#include "core/bus/voice.h"

namespace dance {
namespace {

constexpr double kBin_ms = 4.0;
constexpr Duration kWindow = Duration::s(2);
// Of all packets this part comes in time; chosen with `dance bench voice` over recorded lines.
constexpr double kInTime = 0.985;
// A packet's weight: that of the last five seconds, quicker at the begin.
constexpr double kLeastWeight = 0.002;
constexpr double kFirstWeight = 0.02;
// A late packet is soon followed by others: waited for at once, and forgotten within seconds.
constexpr double kPeakShare = 0.6;
constexpr double kPeakDecay = 0.996;
constexpr Duration kLeastWait = Duration::ms(10);
// Who talks waits no longer than that: what is later still is lost.
constexpr double kMostWait_ms = 480.0;

}  // namespace

void ArrivalDelays::add(std::int64_t frame, MonoTime arrival) {
  const Duration delay = (arrival - MonoTime()) - kVoiceFrame * frame;
  slide(arrival, delay);
  ++count_;
  count(delay - base_);
}

MonoTime ArrivalDelays::quickest(std::int64_t frame) const {
  return MonoTime() + base_ + kVoiceFrame * frame;
}

void ArrivalDelays::slide(MonoTime arrival, Duration delay) {
  if (count_ == 0 || arrival - window_begin_ > kWindow) {
    std::move_backward(quickest_.begin(), quickest_.end() - 1, quickest_.end());
    windows_ = std::min(windows_ + 1, kWindows);
    quickest_[0] = delay;
    window_begin_ = arrival;
  }
  quickest_[0] = std::min(quickest_[0], delay);
  base_ = *std::min_element(quickest_.begin(), quickest_.begin() + windows_);
}

void ArrivalDelays::count(Duration late) {
  const int bin = std::clamp(static_cast<int>(late.as_ms() / kBin_ms), 0, kBins - 1);
  const double weight = std::clamp(1.0 / static_cast<double>(count_), kLeastWeight, kFirstWeight);
  for (float& share : share_) share *= static_cast<float>(1.0 - weight);
  share_[static_cast<std::size_t>(bin)] += static_cast<float>(weight);
  double sum = 0.0;
  for (const float share : share_) sum += static_cast<double>(share);
  double in_time = 0.0;
  int last = 0;
  while (last < kBins - 1) {
    in_time += static_cast<double>(share_[static_cast<std::size_t>(last)]);
    if (in_time >= kInTime * sum) break;
    ++last;
  }
  peak_ms_ = std::max(peak_ms_ * kPeakDecay, kPeakShare * late.as_ms());
  const double wait_ms = std::min(std::max((last + 1) * kBin_ms, peak_ms_), kMostWait_ms);
  wait_ = std::max(kLeastWait, Duration::seconds(wait_ms * 1e-3));
}

}  // namespace dance
