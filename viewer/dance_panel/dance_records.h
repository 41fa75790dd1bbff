// DanceRecords: what the dance panel knows of the guests of the room and of this house: who is
// here, how well each comes over, how the link stands, how loud the own microphones are.
//
// Units/frames: MonoTime of the house's clock.
// Ownership:    plain values; at most kMost guests. What a person has chosen of a guest outlives
//               the guest's going.
// Threads:      the drawing thread.
// Failure:      none; of more guests the rest is left out.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "viewer/dance_panel/dance_board.h"
#include "viewer/dance_panel/quality.h"
#include "viewer/instruments/instrument_records.h"
#include "viewer/scene/scene.h"

namespace dance {

struct DanceGuest {
  GuestId id;
  bool is_remote = true;
  MonoTime came;     // heard of first
  MonoTime present;  // when it was last shown, or last named by the link or (own guest) the manager
  MonoTime named;    // when it was last named by the link or the manager
  MonoTime moved;    // a pose came last
  std::int64_t received = 0;
  QualityMeter quality;
  float voice = 0.0f;  // loudness, 0 = silent to 1
  VoiceMark voice_mark = VoiceMark::kNone;
};

// What a person has chosen of a guest, for this window.
struct GuestChoice {
  float volume = 1.0f;  // of the voice, 0 to 2
  bool is_voice_muted = false;
  bool is_hidden = false;

  float heard_volume() const { return is_voice_muted ? 0.0f : volume; }
  bool operator==(const GuestChoice&) const = default;
};

class DanceRecords {
 public:
  static constexpr std::size_t kMost = 128;
  static constexpr Duration kGone = Duration::s(4);  // the link names who is here each second
  static constexpr Duration kOwnGone =
      Duration::s(600);  // a guest of this house, whose camera may come back
  static constexpr Duration kLossOver = Duration::s(5);
  static constexpr Duration kLevelHolds = Duration::ms(500);

  // Once a picture: what came, and how it is to be judged.
  void take(DanceBoard& board, MonoTime now);
  void judge(const InstrumentRecords& figures, const SceneState& scene, MonoTime now);

  // By name.
  const std::vector<DanceGuest>& guests() const { return guests_; }
  const DanceGuest* find(const GuestId& guest) const;
  GuestChoice& choice_of(const GuestId& guest) { return choices_[guest]; }
  bool is_voice_muted(const GuestId& guest) const {
    const auto known = choices_.find(guest);
    return known != choices_.end() && known->second.is_voice_muted;
  }
  const std::map<GuestId, GuestChoice>& choices() const { return choices_; }

  const std::optional<DanceBoard::HeardLink>& link() const { return link_; }
  const std::optional<Music>& music() const { return music_; }
  // The house band's song.
  const std::optional<RoomSong>& song() const { return song_; }
  // Of a guest of this house; nothing where none is told.
  std::optional<VoiceLevel> level_of(const GuestId& guest, MonoTime now) const;

 private:
  struct Level {
    VoiceLevel level;
    MonoTime at;
  };
  DanceGuest* guest_of(const GuestId& guest, MonoTime now);
  void forget_gone(MonoTime now);

  std::vector<DanceGuest> guests_;
  std::map<GuestId, GuestChoice> choices_;
  std::map<GuestId, Level> levels_;
  std::optional<DanceBoard::HeardLink> link_;
  std::optional<Music> music_;
  std::optional<RoomSong> song_;
};

}  // namespace dance
