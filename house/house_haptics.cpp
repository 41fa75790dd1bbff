#include "house/house_haptics.h"

#include <utility>

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "house/session_haptics.h"

namespace dance {
namespace {

constexpr Duration kHapticsLook = Duration::ms(200);
constexpr Duration kHapticsPause = Duration::s(10);
constexpr Duration kHapticsEnds = Duration::s(2);
constexpr int kHapticsWrongUse = 2;

}  // namespace

std::unique_ptr<HouseHaptics> HouseHaptics::open(const HostedHaptics& haptics,
                                                 const std::string& bus, Poller& poller) {
  std::unique_ptr<HouseHaptics> made(new HouseHaptics(haptics, bus, poller));
  if (!made->start()) return made;
  made->watch_ = poller.add_timer(mono_now() + kHapticsLook,
                                  [self = made.get()](MonoTime now) { return self->look(now); });
  return made;
}

HouseHaptics::HouseHaptics(const HostedHaptics& haptics, const std::string& bus, Poller& poller)
    : guest_(haptics.guest), arguments_(haptics_arguments(haptics, bus)), poller_(poller) {}

HouseHaptics::~HouseHaptics() {
  if (watch_ != 0) poller_.remove_timer(watch_);
  if (program_) program_->stop(kHapticsEnds);
}

bool HouseHaptics::start() {
  // What it cannot have is not to be said every ten seconds.
  const std::string talk_file = last_exit_ == 1 ? "/dev/null" : "";
  auto program = ChildProcess::start(
      {program_folder() + "/dance-haptics", arguments_, "/dev/null", talk_file});
  if (!program) {
    talk::warn("{}; {} feels nothing", program.error().what, guest_.view());
    return false;
  }
  program_ = std::make_unique<ChildProcess>(std::move(*program));
  return true;
}

MonoTime HouseHaptics::look(MonoTime now) {
  if (!program_) return start() ? now + kHapticsLook : MonoTime();
  if (!program_->has_ended()) return now + kHapticsLook;
  const int exit_code = program_->exit_code();
  if (exit_code == 0 || exit_code == kHapticsWrongUse) {
    talk::warn("dance haptics of {} {}; the house goes on", guest_.view(), program_->exit_text());
    return MonoTime();
  }
  if (std::exchange(last_exit_, exit_code) != exit_code)
    talk::warn("dance haptics of {} {}; the house goes on, and starts it again every ten seconds",
               guest_.view(), program_->exit_text());
  program_.reset();
  return now + kHapticsPause;
}

}  // namespace dance
