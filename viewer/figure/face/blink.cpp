#include "viewer/figure/face/blink.h"

#include "viewer/figure/face/guest_noise.h"

namespace dance {
namespace {

constexpr std::int64_t kPeriod_ns = 3'700'000'000;  // one blink in each, anywhere in it
constexpr double kCloses_s = 0.07;
constexpr double kOpens_s = 0.13;
constexpr std::uint64_t kStream = 0;

}  // namespace

float blink_at(const GuestId& guest, MonoTime time) {
  const GuestNoise::Moment at = GuestNoise::moment_of(time, kPeriod_ns);
  const double room_s = 1e-9 * static_cast<double>(kPeriod_ns) - kCloses_s - kOpens_s;
  const double t_s = at.s - room_s * GuestNoise(guest, kStream).draw(at.period);
  if (t_s <= 0.0 || t_s >= kCloses_s + kOpens_s) return 0.0f;
  const double x = t_s < kCloses_s ? t_s / kCloses_s : 1.0 - (t_s - kCloses_s) / kOpens_s;
  return static_cast<float>(smooth_step(x));
}

}  // namespace dance
