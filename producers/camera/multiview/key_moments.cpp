#include "producers/camera/multiview/key_moments.h"

namespace dance {
namespace {

// Errors of a network last a tenth of a second: what is nearer tells little more.
constexpr Duration kApart = Duration::ms(80);
// In standard deviations of a ray, the mean of all points.
constexpr double kLeastWay = 2.5;

}  // namespace

bool KeyMoments::add(const ViewPoints& points) {
  if (count() > 0) {
    const ViewPoints& last = entry(added_ - 1);
    if (points.time - last.time < kApart || way_between(last, points) < kLeastWay) return false;
  }
  (*ring_)[static_cast<std::size_t>(added_++ % kCapacity)] = points;
  if (count() > kCapacity) ++first_;
  return true;
}

void KeyMoments::drop_before(MonoTime time) {
  while (count() > 0 && entry(first_).time < time) ++first_;
}

}  // namespace dance
