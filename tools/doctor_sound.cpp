#include "tools/doctor_sound.h"

namespace dance {
namespace {

// A loudspeaker this late is one on a radio link or a television, whose own delay a server knows but in part.
constexpr Duration kLongLatency = Duration::ms(450);

}  // namespace

Finding check_loudspeaker(const Result<Loudspeaker>& loudspeaker) {
  Finding finding{"sound", Finding::Grade::kNote, "", ""};
  if (!loudspeaker) {
    finding.what = loudspeaker.error().what;
    finding.cure = "systemctl --user start pulseaudio   (or pipewire-pulse)";
    return finding;
  }
  const std::string latency_ms = std::to_string(loudspeaker->latency.count_ms());
  finding.what = loudspeaker->description;
  if (loudspeaker->leads_nowhere) {
    finding.what += ": leads nowhere, so music keeps the time unheard";
    finding.cure = "pactl list short sinks   (then pactl set-default-sink NAME)";
  } else if (loudspeaker->is_muted) {
    finding.what += ": is muted";
    finding.cure = "pactl set-sink-mute " + loudspeaker->name + " 0";
  } else if (loudspeaker->latency > kLongLatency) {
    finding.what += ": " + latency_ms +
                    " ms late by what the server knows, which is counted out; there may be more";
    finding.cure = "dance music SONG --trim 100ms   (by how much later than the beat it is heard)";
  } else {
    finding.grade = Finding::Grade::kOk;
    finding.what += ", " + latency_ms + " ms late, which is counted out";
  }
  return finding;
}

#if defined(DANCE_HAVE_MUSIC)
Finding check_sound() { return check_loudspeaker(default_loudspeaker("doctor")); }
#else
Finding check_sound() {
  return {"sound", Finding::Grade::kNote, "this dance was built without music",
          "apt-get install libsndfile1-dev libpulse-dev   (and build again)"};
}
#endif

}  // namespace dance
