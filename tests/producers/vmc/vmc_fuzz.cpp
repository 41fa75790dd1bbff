// Packets as a stranger might send them to the port of the VMC protocol: what comes out must be
// poses, and nothing may hang.
#include <cstdint>
#include <span>

#include "core/base/assert.h"
#include "producers/vmc/vmc_receiver.h"
#include "tests/fuzz_target.h"

namespace {

class CheckedCaptures : public dance::CaptureSink {
 public:
  void capture(const dance::GuestId&, dance::Pose& pose, dance::MonoTime) override {
    DANCE_ASSERT(dance::is_valid(pose));
  }
  void capture(const dance::GuestId&, const dance::Hands& hands) override {
    DANCE_ASSERT(dance::is_valid(hands));
  }
  void capture(const dance::GuestId&, const dance::TimedSkeleton& timed) override {
    DANCE_ASSERT(dance::is_valid(timed));
  }
};

}  // namespace

// The first two bytes cut the rest into packets of that many bytes.
DANCE_FUZZ_TARGET(vmc) {
  if (size < 2) return 0;
  const std::size_t packet = std::size_t{data[0]} * 256 + data[1] + 1;
  CheckedCaptures sink;
  dance::VmcIntake intake(*dance::GuestId::parse("fuzz"), sink);
  dance::MonoTime now = dance::MonoTime::from_us(1'000'000);
  std::span<const std::uint8_t> rest(data + 2, size - 2);
  while (!rest.empty()) {
    const auto one = rest.first(std::min(packet, rest.size()));
    rest = rest.subspan(one.size());
    now += dance::Duration::ms(8);
    intake.take(one, now, now);
  }
  return 0;
}
