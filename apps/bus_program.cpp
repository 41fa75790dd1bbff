#include "apps/bus_program.h"

#include "core/net/mono_clock.h"

namespace dance {

Result<BusProgram> BusProgram::open(const std::string& bus_url) {
  BusProgram program;
  DANCE_TRY(program.poller_, Poller::create());
  if (auto blocked = program.poller_->stop_on_signals(); !blocked)
    return tl::make_unexpected(blocked.error());
  DANCE_TRY(program.bus_, Bus::open(bus_url));
  return program;
}

void BusProgram::stop_after(double seconds) {
  if (seconds <= 0.0) return;
  poller_->add_timer(mono_now() + Duration::seconds(seconds), [poller = poller_.get()](MonoTime) {
    poller->stop();
    return MonoTime();
  });
}

void BusProgram::every(Duration period, std::function<void(MonoTime now)> work) {
  poller_->add_timer(mono_now() + period, [period, work = std::move(work)](MonoTime now) {
    work(now);
    return now + period;
  });
}

void BusProgram::run() {
  poller_->watch(bus_->fd(), [bus = bus_.get()](MonoTime now) { bus->drain(now); });
  poller_->run();
}

}  // namespace dance
