#include "viewer/figure/blink.h"

#include <cstdint>

#include "core/base/fnv1a.h"
#include "core/base/smooth_step.h"

namespace dance {
namespace {

constexpr std::int64_t kPeriod_ns = 3'700'000'000;  // one blink in each, anywhere in it
constexpr double kCloses_s = 0.07;
constexpr double kOpens_s = 0.13;

std::uint64_t mixed(std::uint64_t x) {  // splitmix64
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

float blink_at(const GuestId& guest, MonoTime time) {
  const std::uint64_t seed = fnv1a(guest.view());
  const std::int64_t period = time.since_zero_ns() / kPeriod_ns;
  const double room_s = 1e-9 * static_cast<double>(kPeriod_ns) - kCloses_s - kOpens_s;
  const std::uint64_t draw = mixed(seed + 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(period));
  const double begins_s = room_s * static_cast<double>(draw >> 11) * 0x1p-53;
  const double t_s = 1e-9 * static_cast<double>(time.since_zero_ns() % kPeriod_ns) - begins_s;
  if (t_s <= 0.0 || t_s >= kCloses_s + kOpens_s) return 0.0f;
  const double x = t_s < kCloses_s ? t_s / kCloses_s : 1.0 - (t_s - kCloses_s) / kOpens_s;
  return static_cast<float>(smooth_step(x));
}

}  // namespace dance
