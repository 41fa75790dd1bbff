// DeviceTroubles: reports each error of a device once and not at each new try, and once that the
// device works again.
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
  // Reports an error, unless it is the one that was reported of this device last.
  void add(VoiceDevice device, const std::string& what) {
    std::string& last = last_[static_cast<std::size_t>(device)];
    if (what == last) return;
    last = what;
    recoveries_.clear();  // a newer error replaces them
    append(errors_, what);
  }
  // Call when a device works. If it had an error, reports the recovery; the next error is reported
  // again.
  void clear(VoiceDevice device) {
    constexpr std::array kNames{"the sound server", "the loudspeaker", "the microphone",
                                "echo cancellation"};
    const auto index = static_cast<std::size_t>(device);
    if (!last_[index].empty()) append(recoveries_, std::string(kNames[index]) + " works again");
    last_[index].clear();
  }
  // Errors since the last call; "" if there are none.
  std::string take() { return std::exchange(errors_, std::string()); }
  // Recoveries since the last call; "" if there are none.
  std::string take_recoveries() { return std::exchange(recoveries_, std::string()); }

 private:
  static void append(std::string& list, const std::string& what) {
    list += (list.empty() ? "" : "; ") + what;
  }

  std::array<std::string, 4> last_;
  std::string errors_, recoveries_;
};

}  // namespace dance
