#include "viewer/dance_panel/music_desk.h"

#include <algorithm>

#include "core/base/music/music_speed.h"

namespace dance {

void MusicDesk::work(bool is_shown, MonoTime now) {
  if (changed_.is_set() && now - changed_ > kRests) keep();
  if (!is_shown || !needs_.plays_here || (looked_.is_set() && now - looked_ < kLook)) return;
  looked_ = now;
  is_there_ = needs_.plays_here();
}

void MusicDesk::set(double volume, MonoTime now) {
  volume_ = std::clamp(volume, 0.0, 1.0);
  changed_ = now;
  is_muted_ = false;
  tell(volume_);
}

void MusicDesk::tell(double volume) {
  trouble_.clear();
  if (!needs_.tell) return;
  if (const auto told = needs_.tell(volume); !told) trouble_ = told.error().what;
}

// Without music in this house the key does nothing.
void MusicDesk::toggle_mute() {
  if (!needs_.plays_here || !needs_.plays_here()) return;
  is_muted_ = !is_muted_;
  tell(is_muted_ ? 0.0 : volume_);
}

void MusicDesk::set_speed(double speed) {
  speed = stepped_music_speed(speed, 0);
  if (speed == speed_) return;
  speed_ = speed;
  trouble_.clear();
  if (!needs_.send_speed) return;
  if (const auto told = needs_.send_speed(speed); !told) trouble_ = told.error().what;
}

void MusicDesk::control_band(BandRequest request, int style) {
  trouble_.clear();
  if (const auto sent = needs_.control_band(request, style); !sent) trouble_ = sent.error().what;
}

void MusicDesk::keep() {
  if (!changed_.is_set()) return;
  changed_ = MonoTime();
  if (!needs_.keep) return;
  if (const auto kept = needs_.keep(volume_); !kept) trouble_ = kept.error().what;
}

}  // namespace dance
