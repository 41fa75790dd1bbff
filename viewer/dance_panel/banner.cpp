#include "viewer/dance_panel/banner.h"

#include <cmath>

#include "viewer/words/shown_name.h"

namespace dance {
namespace {

// From when on it is a trouble, and not a moment's.
constexpr Duration kLinkTold = Duration::s(4);  // it is said once a second
constexpr Duration kLinkDown = Duration::s(3);
constexpr Duration kClosed = Duration::s(1);  // a server that restarts is back by then
constexpr Duration kStill = Duration::s(4);
constexpr Duration kMicrophoneSilent = Duration::s(20);
constexpr Duration kSpeaksMuted = Duration::ms(1500);
constexpr Duration kClockJumpTold = Duration::s(15);

std::string seconds_text(Duration duration) {
  return std::to_string(std::llround(std::abs(duration.as_seconds())));
}

std::string minutes_until(MonoTime when, MonoTime now) {
  return std::to_string(std::max<std::int64_t>(1, ((when - now).count_ms() + 59'999) / 60'000));
}

bool is_down_for(HouseLinkTrouble trouble) {
  return trouble == HouseLinkTrouble::kNone || trouble == HouseLinkTrouble::kNoAnswer ||
         trouble == HouseLinkTrouble::kInterrupted;
}

void note_link(const BannerFacts& facts, BannerSet& set) {
  const auto note = [&](BannerKind kind, bool is) {
    if (is) set.set(static_cast<std::size_t>(kind));
  };
  if (!facts.link) return;
  const HouseLink& link = *facts.link;
  // What it said last is old.
  if (facts.link_silent > kLinkTold) return note(BannerKind::kLinkGone, true);
  const bool is_up = link.state == HouseLinkState::kConnected;
  note(BannerKind::kRemoved, link.trouble == HouseLinkTrouble::kRemoved);
  // Of one more guest that is not let in, too.
  note(BannerKind::kRefused, link.trouble == HouseLinkTrouble::kRefused);
  if (is_up) return;
  note(BannerKind::kKeyRefused, link.trouble == HouseLinkTrouble::kWrongKey);
  note(BannerKind::kServerKeyChanged, link.trouble == HouseLinkTrouble::kServerKeyChanged);
  note(BannerKind::kNotTrusted, link.trouble == HouseLinkTrouble::kNotTrusted);
  note(BannerKind::kRoomClosed,
       link.trouble == HouseLinkTrouble::kClosed && facts.link_down > kClosed);
  note(BannerKind::kServerSilent, is_down_for(link.trouble) && facts.link_down > kLinkDown);
}

}  // namespace

BannerSet troubles_of(const BannerFacts& facts) {
  BannerSet set;
  note_link(facts, set);
  const auto note = [&](BannerKind kind, bool is) { set.set(static_cast<std::size_t>(kind), is); };
  note(BannerKind::kNoPoses, facts.still.is_set() && facts.still_for > kStill);
  note(BannerKind::kRecordingFailed, !facts.recording_trouble.empty());
  note(BannerKind::kNoSound, facts.lacks_sound);
  note(BannerKind::kNoMicrophone, facts.lacks_microphone);
  note(BannerKind::kMicrophoneSilent, facts.microphone_silent > kMicrophoneSilent);
  note(BannerKind::kSpeaksMuted, facts.speaks_muted > kSpeaksMuted);
  note(BannerKind::kClockJumped,
       facts.clock_jump != Duration() && facts.since_clock_jump < kClockJumpTold);
  return set;
}

Banner banner_of(BannerKind kind, const BannerFacts& facts, const Texts& texts) {
  Banner banner;
  banner.kind = kind;
  const auto say = [&](Text what, Text cure) {
    banner.what = texts[what];
    banner.cure = texts[cure];
  };
  switch (kind) {
    case BannerKind::kRemoved:
      banner.what = texts[Text::kBannerRemoved];
      banner.cure = texts.say(Text::kBannerRemovedCure,
                              {facts.link ? minutes_until(facts.link->asks_again, facts.link->time)
                                          : std::string("10")});
      banner.action = BannerAction::kLeave;
      break;
    case BannerKind::kKeyRefused:
      say(Text::kBannerKey, Text::kBannerKeyCure);
      break;
    case BannerKind::kServerKeyChanged:
      say(Text::kBannerServerKey, Text::kBannerServerKeyCure);
      break;
    case BannerKind::kNotTrusted:
      say(Text::kBannerNotTrusted, Text::kBannerNotTrustedCure);
      break;
    case BannerKind::kRefused:
      say(Text::kBannerRefused, Text::kBannerRefusedCure);
      if (facts.link && facts.link->refused.is_set())
        banner.what = texts.say(Text::kBannerRefusedGuest, {facts.link->refused.view()});
      break;
    case BannerKind::kLinkGone:
      say(Text::kBannerLinkGone, Text::kBannerLinkGoneCure);
      break;
    case BannerKind::kRoomClosed:
      say(Text::kBannerRoomClosed, Text::kBannerRoomClosedCure);
      if (facts.host.is_set()) {
        banner.what =
            texts.say(Text::kBannerHostClosed, {shown_name(facts.names, facts.host, texts)});
        banner.cure = texts[Text::kBannerHostClosedCure];
      }
      banner.action = BannerAction::kLeave;
      break;
    case BannerKind::kServerSilent:
      say(Text::kBannerServer, Text::kBannerServerCure);
      break;
    case BannerKind::kNoPoses:
      banner.what = texts.say(Text::kBannerNoPoses, {shown_name(facts.names, facts.still, texts),
                                                     seconds_text(facts.still_for)});
      banner.cure = texts[Text::kBannerNoPosesCure];
      break;
    case BannerKind::kRecordingFailed:
      banner.what = texts[Text::kBannerRecording];
      banner.cure = facts.recording_trouble;
      break;
    case BannerKind::kNoSound:
      say(Text::kBannerNoSound, Text::kBannerNoSoundCure);
      break;
    case BannerKind::kNoMicrophone:
      say(Text::kBannerNoMicrophone, Text::kBannerNoMicrophoneCure);
      break;
    case BannerKind::kMicrophoneSilent:
      say(Text::kBannerMicrophone, Text::kBannerMicrophoneCure);
      break;
    case BannerKind::kSpeaksMuted:
      say(Text::kBannerMuted, Text::kBannerMutedCure);
      banner.action = BannerAction::kUnmute;
      break;
    case BannerKind::kClockJumped:
      banner.what = texts.say(Text::kBannerClock, {seconds_text(facts.clock_jump)});
      banner.cure = texts[Text::kBannerClockCure];
      break;
    case BannerKind::kCount:
      break;
  }
  banner.is_grave = kind <= BannerKind::kNoPoses;
  return banner;
}

std::optional<BannerKind> BannerChoice::choose(const BannerFacts& facts) {
  const BannerSet now = troubles_of(facts);
  closed_ &= now;
  const BannerSet open = now & ~closed_;
  for (std::size_t i = 0; i < kBannerKinds; ++i)
    if (open[i]) return static_cast<BannerKind>(i);
  return std::nullopt;
}

}  // namespace dance
