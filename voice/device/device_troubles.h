// DeviceTroubles: what is wrong with each device, said once and not at each new try.
//
// Units/frames: none.
// Ownership:    plain value; one text for each device.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>
#include <string>
#include <utility>

namespace dance {

enum class VoiceDevice { kServer, kLoudspeaker, kMicrophone, kReference };

class DeviceTroubles {
 public:
  // To be said, unless it is what was said of this device last.
  void add(VoiceDevice device, const std::string& what) {
    std::string& last = last_[static_cast<std::size_t>(device)];
    if (what == last) return;
    last = what;
    untold_ = untold_.empty() ? what : untold_ + "; " + what;
  }
  // The device works: its next trouble is said again.
  void clear(VoiceDevice device) { last_[static_cast<std::size_t>(device)].clear(); }
  // "" once it has been told.
  std::string take() { return std::exchange(untold_, std::string()); }

 private:
  std::array<std::string, 4> last_;
  std::string untold_;
};

}  // namespace dance
