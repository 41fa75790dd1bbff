// DancePanel: the house band, and the roles of synthetic dancers.
#include <tuple>

#include "core/base/music/music_speed.h"
#include "viewer/dance_panel/dance_panel.h"
#include "viewer/dance_panel/panel_style.h"

namespace dance {
namespace {

Text style_text(int style) {
  static_assert(static_cast<int>(Text::kBandWaltz) - static_cast<int>(Text::kBandSalsa) ==
                RoomSong::kStyles - 1);
  return static_cast<Text>(static_cast<int>(Text::kBandSalsa) + style);
}

// Places buttons side by side, and begins a new line when one is full.
class ButtonRow {
 public:
  explicit ButtonRow(PanelControls& controls) : controls_(controls) {}
  bool button(const char* id, const char* label) {
    if (!is_first_) controls_.flow(controls_.width_of(label));
    is_first_ = false;
    return controls_.button(id, label);
  }

 private:
  PanelControls& controls_;
  bool is_first_ = true;
};

struct BandButton {
  const char* id;
  BandRequest request;
  Text label;
};

}  // namespace

std::optional<std::string> DancePanel::band_title() const {
  const auto& song = records_.song();
  if (!song || !song->playing) return std::nullopt;
  return texts_.say(Text::kBandTitle, {texts_[style_text(song->style)]});
}

// Requests that change the song of everybody in the room.
void DancePanel::draw_band() {
  const auto& song = records_.song();
  if (!song || !music_.is_there() || !needs_.music.control_band) return;
  const BandButton play = song->playing
                              ? BandButton{"band-stop", BandRequest::kPause, Text::kBandStop}
                              : BandButton{"band-play", BandRequest::kPlay, Text::kBandPlay};
  ButtonRow row(controls_);
  for (const BandButton& button :
       {BandButton{"band-slower", BandRequest::kSlower, Text::kBandSlower},
        BandButton{"band-faster", BandRequest::kFaster, Text::kBandFaster},
        BandButton{"band-next", BandRequest::kNext, Text::kBandNext}, play})
    if (row.button(button.id, texts_[button.label]))
      music_.control_band(button.request, song->style);
  const int next = (song->style + 1) % RoomSong::kStyles;
  const std::string label = texts_.say(Text::kBandStyle, {texts_[style_text(song->style)]});
  if (row.button("band-style", label.c_str())) music_.control_band(BandRequest::kStyle, next);
  // The server enforces the lock, and accepts one from a host alone.
  if (may_remove()) {
    const Text lock = song->locked ? Text::kBandUnlock : Text::kBandLock;
    if (row.button("band-lock", texts_[lock]))
      music_.control_band(song->locked ? BandRequest::kUnlock : BandRequest::kLock, song->style);
  } else if (song->locked) {
    panel_style::text(panel_style::kQuiet, texts_[Text::kBandLocked]);
  }
}

// A file that this house plays, in no room.
bool DancePanel::has_own_song() const {
  return music_.is_there() && records_.music() && !records_.link() && !records_.song();
}

// Music is heard here whose beats are not known yet.
bool DancePanel::finds_beat(const PanelFrame& frame) const {
  if (frame.scene.music || !music_.is_there() || records_.song()) return false;
  return has_own_song() ? records_.music()->playing : !records_.music();
}

void DancePanel::draw_own_song() {
  if (!needs_.music.control_band || !needs_.music.send_speed) return;
  auto speed = static_cast<float>(music_.speed());
  const std::string words =
      texts_.say(Text::kDanceMusicSpeed, {std::to_string(std::lround(100.0 * music_.speed()))});
  if (controls_.slider("music-speed",
                       ImGui::GetContentRegionAvail().x - 0.3f * ImGui::GetFontSize(), speed,
                       static_cast<float>(kLeastMusicSpeed), static_cast<float>(kMostMusicSpeed),
                       static_cast<float>(kMusicSpeedStep), words.c_str()))
    music_.set_speed(static_cast<double>(speed));
  const bool plays = records_.music()->playing;
  ButtonRow row(controls_);
  if (row.button("song-stop", texts_[plays ? Text::kBandStop : Text::kBandPlay]))
    music_.control_band(plays ? BandRequest::kPause : BandRequest::kPlay, 0);
  if (row.button("song-next", texts_[Text::kBandNext])) music_.control_band(BandRequest::kNext, 0);
}

void DancePanel::draw_roles(const DanceGuest& guest, MonoTime now) {
  if (guest.is_remote || !needs_.has_role) return;
  if (role_guest_ != guest.id || now - role_read_ > MusicDesk::kLook) {
    role_guest_ = guest.id;
    role_read_ = now;
    has_role_ = needs_.has_role(guest.id);
  }
  if (!has_role_) return;
  ButtonRow row(controls_);
  for (const auto& [id, role, label] : {std::tuple{"role-lead", "lead", Text::kRoleLead},
                                        std::tuple{"role-follow", "follow", Text::kRoleFollow},
                                        std::tuple{"role-either", "any", Text::kRoleEither}}) {
    if (!row.button(id, texts_[label])) continue;
    const auto sent = needs_.send_role(guest.id, role);
    if (!sent) voice_trouble_ = sent.error().what;
  }
}

}  // namespace dance
