#include "headset/program/headset_run.h"

#include <algorithm>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr Duration kLookAgain = Duration::s(2);
constexpr Duration kNotRunning = Duration::ms(10);
constexpr Duration kPutDown = Duration::ms(1500);
constexpr Duration kGraceful = Duration::ms(500);

}  // namespace

bool HeadsetRun::is_over() const {
  return is_over_ || show_.is_over() || (ends_.is_set() && mono_now() > ends_);
}

Result<void> HeadsetRun::run() {
  if (options_.seconds > 0.0) ends_ = mono_now() + Duration::seconds(options_.seconds);
  while (!is_over()) {
    guard_.beat();
    const auto danced = dance_once();
    if (!danced && is_fatal_) {
      sum_up();
      return danced;
    }
    if (is_over()) break;
    if (!danced && danced.error().what != trouble_) {
      trouble_ = danced.error().what;
      talk::warn("{}; it is looked for again, and the dance goes on", trouble_);
    }
    for (const MonoTime until = mono_now() + kLookAgain; mono_now() < until && !is_over();) {
      guard_.beat();
      show_.wait(std::min(until - mono_now(), Duration::ms(50)));
    }
  }
  sum_up();
  return {};
}

void HeadsetRun::sum_up() const {
  if (const std::string summary = show_.summary(); !summary.empty()) talk::info("{}", summary);
}

// The runtime is kept while its headset sleeps.
Result<void> HeadsetRun::find_headset() {
  if (!runtime_) {
    DANCE_TRY(runtime_, XrRuntime::start(show_.use()));
  }
  auto found = runtime_->find_headset();
  if (!found && runtime_->is_lost()) runtime_.reset();
  return found;
}

Result<void> HeadsetRun::dance_once() {
  if (auto found = find_headset(); !found) return found;
  const auto danced = begin();
  // Another session wants another instance with many runtimes.
  guard_.beat();
  runtime_.reset();
  return danced;
}

Result<void> HeadsetRun::begin() {
  const auto binding = show_.binding(*runtime_);
  if (!binding) {
    is_fatal_ = true;
    return tl::make_unexpected(binding.error());
  }
  DANCE_TRY(const auto session, XrDancerSession::create(*runtime_, *binding));
  DANCE_TRY(const auto input, XrInput::create(*session));
  DANCE_TRY(const auto capture, HeadsetCapture::start(*session, *input, options_.capture, memory_));
  auto danced = show_.begin(*session, *input, *capture);
  if (danced) {
    const char* verb = was_there_ ? "is back" : "is here";
    talk::info("{} {}: {} dances with it", runtime_->name(), verb, options_.capture.guest.view());
    was_there_ = true;
    trouble_.clear();
    is_worn_ = true;
    worn_ = mono_now();
    danced = pump(*session);
  }
  memory_ = capture->stop();
  show_.end();
  talk::info("{}", capture->summary());
  return danced;
}

Result<void> HeadsetRun::pump(XrDancerSession& session) {
  while (true) {
    guard_.beat();
    session.poll();
    if (session.over() == XrDancerSession::Over::kLost)
      return fail("the headset's runtime has lost its session");
    if (session.over() == XrDancerSession::Over::kEnded) {
      is_fatal_ = true;
      return fail(
          "the headset's runtime has ended the session, as when it is closed or starts anew");
    }
    if (is_over() || show_.has_left()) {
      is_over_ = true;
      end_gracefully(session);
      return {};
    }
    tell_worn(session);
    if (!session.is_running())
      show_.wait(kNotRunning);
    else if (auto turned = show_.turn(); !turned)
      return turned;
  }
}

// One line when it is put down, or its own menu is open, for longer; one when it is worn again.
void HeadsetRun::tell_worn(const XrDancerSession& session) {
  const MonoTime now = mono_now();
  if (session.is_focused()) {
    worn_ = now;
    if (!is_worn_) talk::info("the headset is worn again");
    is_worn_ = true;
  } else if (is_worn_ && now - worn_ > kPutDown) {
    is_worn_ = false;
    talk::warn("the headset is asleep, put down, or shows its own menu; the dance goes on");
  }
}

void HeadsetRun::end_gracefully(XrDancerSession& session) {
  session.ask_to_end();
  const MonoTime until = mono_now() + kGraceful;
  while (mono_now() < until && session.over() == XrDancerSession::Over::kNot) {
    session.poll();
    if (session.is_running()) {
      if (!show_.turn()) return;
    } else {
      show_.wait(Duration::ms(2));
    }
  }
}

}  // namespace dance
