#include "house/voice/house_voice.h"

#include <utility>

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr Duration kVoiceLook = Duration::ms(200);
constexpr Duration kVoicePause = Duration::s(10);
// A sound server that hangs lets it end later than at once.
constexpr Duration kVoiceWorks = Duration::s(10);
constexpr Duration kVoiceEnds = Duration::s(2);
constexpr int kWrongUse = 2;

}  // namespace

std::unique_ptr<HouseVoice> HouseVoice::open(const HostedVoice& voice, const std::string& bus,
                                             Poller& poller) {
  std::unique_ptr<HouseVoice> made(new HouseVoice(voice, bus, poller));
  if (!made->start()) return made;
  made->watch_ = poller.add_timer(mono_now() + kVoiceLook,
                                  [self = made.get()](MonoTime now) { return self->look(now); });
  return made;
}

HouseVoice::HouseVoice(const HostedVoice& voice, const std::string& bus, Poller& poller)
    : arguments_(voice_arguments(voice, bus)), poller_(poller), words_(poller) {}

HouseVoice::~HouseVoice() {
  if (watch_ != 0) poller_.set_deadline(watch_, MonoTime());
  if (program_) program_->stop(kVoiceEnds);
  words_.end();
}

bool HouseVoice::start() {
  ChildProcess::Options options{program_folder() + "/dance-voice", arguments_, "/dev/null", ""};
  options.talk_fd = words_.begin();
  auto program = ChildProcess::start(options);
  words_.started();
  if (!program) {
    talk::warn("{}; the house goes on without voices", program.error().what);
    return false;
  }
  program_ = std::make_unique<ChildProcess>(std::move(*program));
  started_ = mono_now();
  return true;
}

MonoTime HouseVoice::look(MonoTime now) {
  if (!program_) return start() ? now + kVoiceLook : MonoTime();
  if (!program_->has_ended()) {
    if (last_exit_ != 0 && now - started_ >= kVoiceWorks) {
      talk::info("dance voice works again");
      last_exit_ = 0;
      words_.forget();
    }
    return now + kVoiceLook;
  }
  words_.end();
  const int exit_code = program_->exit_code();
  if (exit_code == 0 || exit_code == kWrongUse) {
    talk::warn("dance voice {}; the house goes on without voices", program_->exit_text());
    return MonoTime();
  }
  if (std::exchange(last_exit_, exit_code) != exit_code)
    talk::warn("dance voice {}; the house goes on, and starts it again every ten seconds",
               program_->exit_text());
  program_.reset();
  return now + kVoicePause;
}

}  // namespace dance
