// Banners: what is wrong during the dance, one at a time and the most urgent first, with one
// sentence that says how it is mended, and a button where one press does it.
//
// Units/frames: as the fields say; MonoTime of the house's clock.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      what is not known is no trouble.
#pragma once

#include <bitset>
#include <optional>
#include <string>

#include "core/bus/house_messages.h"
#include "viewer/words/shown_name.h"
#include "viewer/words/texts.h"

namespace dance {

// The most urgent first.
enum class BannerKind : std::uint8_t {
  kRemoved,
  kKeyRefused,
  kServerKeyChanged,
  kNotTrusted,
  kRefused,
  kLinkGone,
  kRoomClosed,
  kServerSilent,
  kNoPoses,
  kRecordingFailed,
  kNoSound,
  kNoMicrophone,
  kMicrophoneSilent,
  kSpeaksMuted,
  kClockJumped,
  kCount,
};
constexpr std::size_t kBannerKinds = static_cast<std::size_t>(BannerKind::kCount);

enum class BannerAction : std::uint8_t { kNone, kLeave, kUnmute };

// What is known of what may be wrong. What is not set is well, or not known.
struct BannerFacts {
  std::optional<HouseLink> link;  // as it was told last
  Duration link_silent;           // since then
  Duration link_down;             // since it had a session, or since it was heard of first
  ShownNames names;
  GuestId host;  // the room's host in another house, kept after the link has lost its session
  // A guest of this house who danced, and since when no pose came.
  GuestId still;
  Duration still_for;
  std::string recording_trouble;  // printable; "" = none
  Duration slow_for;              // for SlowNote
  bool draws_plainly = false;
  float pictures_hz = 60.0f;
  bool lacks_sound = false;       // a dance voice finds neither of its devices
  bool lacks_microphone = false;  // a dance voice runs, and has none
  Duration microphone_silent;     // heard by the others, and nothing comes from it
  Duration speaks_muted;
  Duration clock_jump;  // the newest one; 0 = none
  Duration since_clock_jump;
};

constexpr float kSlow_hz = 20.0f;
constexpr int kSilentMicrophone_dbfs = -75;  // no room is so quiet
constexpr int kSpeech_dbfs = -40;

using BannerSet = std::bitset<kBannerKinds>;

// All that is wrong by now.
BannerSet troubles_of(const BannerFacts& facts);

struct Banner {
  BannerKind kind = BannerKind::kCount;
  std::string what;
  std::string cure;
  BannerAction action = BannerAction::kNone;
  bool is_grave = false;  // nobody sees this house's dance, or it sees nobody
};
Banner banner_of(BannerKind kind, const BannerFacts& facts, const Texts& texts);

// One that a person has closed comes back when its cause went away and came again.
class BannerChoice {
 public:
  std::optional<BannerKind> choose(const BannerFacts& facts);
  void close(BannerKind kind) { closed_.set(static_cast<std::size_t>(kind)); }

 private:
  BannerSet closed_;
};

}  // namespace dance
