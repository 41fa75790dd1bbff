#include "voice/program/voice_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr int kMeterCells = 8;
constexpr int kQuietest_dbfs = -60;
constexpr Duration kHearingSaid = Duration::s(1);
constexpr Duration kLevelPeriod = Duration::ms(100);
constexpr Duration kMeterHolds = Duration::ms(300);

std::string meter(int level) {
  const int cells =
      std::clamp((level - kQuietest_dbfs) * kMeterCells / -kQuietest_dbfs, 0, kMeterCells);
  std::string text;
  for (int i = 0; i < kMeterCells; ++i) text += i < cells ? "▮" : "▯";
  return text;
}

// But for the time.
bool is_same(const VoiceState& a, const VoiceState& b) {
  return a.is_muted == b.is_muted && a.is_deafened == b.is_deafened &&
         a.is_push_to_talk == b.is_push_to_talk && a.is_heard == b.is_heard &&
         a.has_microphone == b.has_microphone && a.has_loudspeaker == b.has_loudspeaker;
}

double concealed_percent(const VoicePlayout::Counters& counters) {
  return counters.played == 0 ? 0.0
                              : 100.0 * static_cast<double>(counters.concealed) /
                                    static_cast<double>(counters.played);
}

}  // namespace

Result<std::unique_ptr<VoiceProgram>> VoiceProgram::open(const VoiceProgramOptions& options,
                                                         SignalPort& bus, Poller& poller) {
  std::unique_ptr<VoiceProgram> program(new VoiceProgram(options, bus, poller));
  VoiceProgram* self = program.get();
  DANCE_TRY(program->own_, OwnVoice::create(options.cleaning, options.encoding, this_clock_id()));
  DANCE_TRY(program->others_, RoomVoices::create());
  DANCE_TRY(
      program->control_,
      VoiceControl::open(
          options.bus, options.guest,
          [self](std::string_view command, MonoTime now) { self->command(command, now); }, poller));
  DANCE_TRY(program->devices_, VoiceDevices::open(options.devices, program->handlers()));
  program->subscribe();
  program->timer_ = poller.add_timer(mono_now(), [self](MonoTime now) {
    self->devices_->work(now);
    self->report_devices();
    self->publish_level(now);
    if (!self->said_ || !is_same(*self->said_, self->state(now))) self->say_state(now);
    return now + VoiceDevices::kTurn;
  });
  program->hearing_timer_ = poller.add_timer(mono_now(), [self](MonoTime now) {
    self->say_hearing(now);
    self->say_state(now);
    return now + kHearingSaid;
  });
  program->say_settings();
  return program;
}

VoiceProgram::VoiceProgram(const VoiceProgramOptions& options, SignalPort& bus, Poller& poller)
    : options_(options),
      settings_(options.settings),
      bus_(bus),
      poller_(poller),
      begin_(mono_now()) {}

VoiceProgram::~VoiceProgram() {
  for (const Poller::TimerId timer : {timer_, hearing_timer_})
    if (timer != 0) poller_.set_deadline(timer, MonoTime());
}

void VoiceProgram::subscribe() {
  bus_.subscribe<Voice>(
      Where::kGuest, [this](const Channel& channel, const Voice& voice, MonoTime now) {
        if (voice.clock_id != this_clock_id() || channel.guest() == options_.guest) return;
        replayed_.see_live(channel.guest(), now);
        others_->hear(channel.guest(), voice, now);
      });
  bus_.subscribe<Voice>(Where::kCapture,
                        [this](const Channel& channel, const Voice& voice, MonoTime now) {
                          hear_capture(channel.guest(), voice, now);
                        });
  bus_.subscribe<VoiceState>(Where::kCapture,
                             [this](const Channel& channel, const VoiceState&, MonoTime now) {
                               replayed_.see_live(channel.guest(), now);
                             });
  bus_.subscribe<Pose>(
      Where::kStage,
      [this](const Channel& channel, const Pose& pose, MonoTime) {
        others_->see(channel.guest(), pose);
      },
      Delivery::kNewest);
  bus_.subscribe<Playout>(Where::kStage,
                          [this](const Channel& channel, const Playout& playout, MonoTime) {
                            others_->know_picture(channel.guest(), playout);
                          });
}

void VoiceProgram::hear_capture(const GuestId& guest, const Voice& voice, MonoTime now) {
  if (voice.clock_id != this_clock_id()) return;
  // The own guest's state is this program's: its packets are known one by one.
  const bool is_live =
      guest == options_.guest ? own_->has_made(voice) : !replayed_.is_replayed(guest, begin_, now);
  if (!is_live) others_->hear(guest, voice, now);
}

VoiceDeviceHandlers VoiceProgram::handlers() {
  VoiceDeviceHandlers handlers;
  handlers.on_microphone = [this](std::span<float, kVoiceFrameSamples> frame, MonoTime captured,
                                  Duration echo_delay) {
    level_.level_dbfs = std::max(level_.level_dbfs, level_dbfs(frame));
    const auto voice = own_->take(frame, captured, echo_delay, settings_.sends(mono_now()));
    level_.cleaned_dbfs = std::max(level_.cleaned_dbfs, own_->level());
    if (voice) bus_.publish(Where::kCapture, options_.guest, *voice);
  };
  handlers.on_reference = [this](std::span<const float, kVoiceFrameSamples> frame) {
    own_->hear_loudspeaker(frame);
  };
  handlers.fill = [this](std::span<float> stereo, MonoTime now, MonoTime heard) {
    others_->mix(stereo, now, heard, options_.guest, settings_);
  };
  return handlers;
}

void VoiceProgram::command(std::string_view command, MonoTime now) {
  const auto applied = settings_.apply(command, now);
  // What was said may be anything: it is not repeated.
  if (!applied) {
    before_words();
    return talk::warn("a command is refused: {}", applied.error().what);
  }
  if (command == "talk" || command == "stop-talking") return;
  say_settings();
  say_hearing(now);
}

void VoiceProgram::say_hearing(MonoTime now) {
  HearingWish wish = settings_.hearing();
  wish.time = now;
  wish.clock_id = this_clock_id();
  wish.listener = options_.guest;
  bus_.publish(Channel::of_house(Signal::kHearing), wish);
}

VoiceState VoiceProgram::state(MonoTime now) const {
  VoiceState state;
  state.time = now;
  state.clock_id = this_clock_id();
  state.is_muted = settings_.is_muted;
  state.is_deafened = settings_.is_deafened;
  state.is_push_to_talk = settings_.is_push_to_talk;
  state.is_heard = settings_.sends(now) && devices_->has_microphone();
  state.has_microphone = devices_->has_microphone();
  state.has_loudspeaker = devices_->has_loudspeaker();
  return state;
}

void VoiceProgram::say_state(MonoTime now) {
  said_ = state(now);
  bus_.publish(Where::kCapture, options_.guest, *said_);
}

void VoiceProgram::publish_level(MonoTime now) {
  if (!devices_->has_microphone() || now - level_.time < kLevelPeriod) return;
  level_.time = now;
  level_.clock_id = this_clock_id();
  bus_.publish(Where::kCapture, options_.guest, level_);
  level_.level_dbfs = level_.cleaned_dbfs = kSilence_dbfs;
}

void VoiceProgram::report_devices() const {
  const std::string errors = devices_->take_errors();
  const std::string recoveries = devices_->take_recoveries();
  if (!errors.empty() || !recoveries.empty()) before_words();
  if (!errors.empty()) talk::warn("{}; goes on with what there is", errors);
  if (!recoveries.empty()) talk::info("{}", recoveries);
}

void VoiceProgram::say_settings() const {
  const std::string push_to_talk =
      options_.has_keys ? "heard while the space bar is held"
                        : fmt::format(
                              "heard while B is held in dance view, or `dance voice set --guest {} "
                              "--talk` is repeated",
                              options_.guest.view());
  before_words();
  talk::info("{} is {}; voices are {}{}", options_.guest.view(),
             settings_.is_muted || settings_.is_deafened ? "muted"
             : settings_.is_push_to_talk                 ? push_to_talk
                                                         : "heard",
             settings_.is_deafened ? "not played" : "played ",
             settings_.is_deafened       ? ""
             : settings_.follows_picture ? "with the picture"
                                         : "at once");
}

std::string VoiceProgram::meters(MonoTime now) const {
  const bool sends = settings_.sends(now);
  std::string text =
      fmt::format("{} {}{}", options_.guest.view(), meter(own_->level()), sends ? "" : " (muted)");
  others_->each([&](const RoomVoices::Guest& guest) {
    if (now - guest.heard > RoomVoices::kLeft) return;
    const bool speaks = guest.playout->is_speaking() && now - guest.heard < kMeterHolds;
    text += fmt::format("   {} {}", guest.guest.view(),
                        meter(speaks ? guest.level_dbfs : kSilence_dbfs));
    if (speaks && guest.playout->delay())
      text += fmt::format(" {} ms", guest.playout->delay()->count_ms());
  });
  return text;
}

std::string VoiceProgram::report_json() const {
  nlohmann::ordered_json report;
  report["guest"] = options_.guest.view();
  report["sent"] = own_->sent();
  report["underflows"] = devices_->underflows();
  report["buffer_ms"] = devices_->ahead().count_ms();
  report["guests"] = nlohmann::ordered_json::object();
  others_->each([&](const RoomVoices::Guest& guest) {
    const VoicePlayout::Counters& counters = guest.playout->counters();
    nlohmann::ordered_json one{{"received", counters.received},
                               {"played", counters.played},
                               {"concealed", counters.concealed},
                               {"recovered", counters.recovered},
                               {"late", counters.late},
                               {"skipped", counters.skipped},
                               {"bad", guest.playout->bad_packets()},
                               {"concealed_percent", concealed_percent(counters)},
                               {"wait_ms", guest.playout->jitter_wait().as_ms()}};
    if (guest.playout->delay()) one["delay_ms"] = guest.playout->delay()->as_ms();
    report["guests"][std::string(guest.guest.view())] = one;
  });
  return report.dump();
}

}  // namespace dance
