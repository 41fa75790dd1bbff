#include "apps/doctor/doctor_sound.h"

#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "core/base/printable.h"
#include "core/net/local_socket.h"
#if defined(DANCE_HAVE_SOUND)
#include "core/sound/pulse_server.h"
#endif

namespace dance {
namespace {

// A loudspeaker this late is on a radio link or in a television, of whose own delay a server knows
// only a part.
constexpr Duration kLongLatency = Duration::ms(450);

std::string variable(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): call from main
  return value != nullptr ? value : "";
}

std::string cure_of_no_server(const SoundFailure& failure) {
  if (failure.is_named)
    return "unset PULSE_SERVER   (it names " + failure.socket + ", where no sound server is)";
  if (failure.installed_server.empty()) return "apt-get install pulseaudio   (and log in again)";
  std::string cure = "systemctl --user start " + failure.installed_server;
  if (failure.installed_server == "pulseaudio") cure += "   (without systemd: pulseaudio --start)";
  return cure;
}

Finding finding_of(const SoundFailure& failure) {
  Finding finding{"sound", Finding::Grade::kNote, "", ""};
  switch (failure.trouble) {
    case SoundTrouble::kNotBuilt:
      finding.what = "this dance was built without music or sound";
      finding.cure = "apt-get install libsndfile1-dev libpulse-dev   (and build again)";
      return finding;
    case SoundTrouble::kNoServer:
      finding.what = "no sound server is running: nobody is at " + failure.socket;
      finding.cure = cure_of_no_server(failure);
      break;
    case SoundTrouble::kNotYours:
      finding.what = "the sound server at " + failure.socket + " is another user's";
      finding.cure = "stat -c %U " + failure.socket + "   (dance as that user)";
      break;
    case SoundTrouble::kRefused:
      finding.what = "the sound server at " + failure.socket + " does not let us in";
      finding.cure =
          "export PULSE_COOKIE=FILE   (that of the server's user: ~/.config/pulse/cookie)";
      break;
    case SoundTrouble::kHangs:
      finding.what = "the sound server at " + failure.socket +
                     " hangs: it accepts the connection and does not answer";
      finding.cure = failure.installed_server == "pipewire-pulse"
                         ? "systemctl --user restart pipewire pipewire-pulse"
                         : "pulseaudio --kill; pulseaudio --start";
      break;
    case SoundTrouble::kNoLoudspeaker:
      finding.what = "the sound server has no loudspeaker";
      finding.cure =
          "pactl load-module module-udev-detect   (then pactl list short sinks; aplay -l lists the "
          "cards that the kernel knows)";
      break;
    case SoundTrouble::kFarServer:
      finding.what =
          "the sound server that PULSE_SERVER names, " + failure.socket + ", has no answer for us";
      finding.cure = "unset PULSE_SERVER   (to play on this machine)";
      break;
  }
  if (!failure.reason.empty()) finding.what += " (" + printable(failure.reason) + ")";
  return finding;
}

#if defined(DANCE_HAVE_MUSIC) && defined(DANCE_HAVE_SOUND)
// Of a sound server: the client sends first.
constexpr Duration kKnock = Duration::ms(100);

std::string installed_server() {
  for (const std::string_view program : {"pipewire-pulse", "pulseaudio"}) {
    std::error_code error;
    if (std::filesystem::exists(std::filesystem::path("/usr/bin") / program, error))
      return std::string(program);
  }
  return "";
}

// Why there is no loudspeaker: what listens at the socket, and whether it accepts the connection.
SoundFailure why_not(std::string reason) {
  SoundFailure failure;
  failure.socket = sound_server_place();
  failure.is_named = !variable("PULSE_SERVER").empty();
  failure.installed_server = installed_server();
  const auto server = PulseServer::connect("doctor");
  if (server) {
    failure.trouble = SoundTrouble::kNoLoudspeaker;
    failure.reason = std::move(reason);
    return failure;
  }
  if (!failure.socket.starts_with('/')) {
    failure.trouble = SoundTrouble::kFarServer;
    return failure;
  }
  failure.trouble = server.error().is_silent ? SoundTrouble::kHangs : SoundTrouble::kRefused;
  if (server.error().is_silent) return failure;
  const auto answer = read_local_text(failure.socket, kKnock);
  if (answer || answer.error().trouble == LocalTrouble::kSilent) return failure;
  if (answer.error().trouble == LocalTrouble::kNobody) failure.trouble = SoundTrouble::kNoServer;
  if (answer.error().trouble == LocalTrouble::kNotYours) failure.trouble = SoundTrouble::kNotYours;
  failure.reason = answer.error().reason;
  return failure;
}
#endif

}  // namespace

Finding check_loudspeaker(const tl::expected<Loudspeaker, SoundFailure>& loudspeaker) {
  if (!loudspeaker) return finding_of(loudspeaker.error());
  // What a sound server calls its devices anybody may have written.
  Finding finding{"sound", Finding::Grade::kNote, printable(loudspeaker->description), ""};
  const std::string latency_ms = std::to_string(loudspeaker->latency.count_ms());
  if (loudspeaker->leads_nowhere) {
    finding.what += ": leads nowhere, so music keeps the time unheard";
    finding.cure = "pactl list short sinks   (then pactl set-default-sink NAME)";
  } else if (loudspeaker->is_muted) {
    finding.what += ": is muted";
    finding.cure = "pactl set-sink-mute " + printable(loudspeaker->name) + " 0";
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

std::string sound_server_place() {
  constexpr std::string_view kUnix = "unix:";
  const std::string named = variable("PULSE_SERVER");
  if (named.starts_with(kUnix)) return named.substr(kUnix.size());
  if (!named.empty()) return named;
  if (const std::string folder = variable("PULSE_RUNTIME_PATH"); !folder.empty())
    return folder + "/native";
  if (const std::string folder = variable("XDG_RUNTIME_DIR"); !folder.empty())
    return folder + "/pulse/native";
  return "/run/pulse/native";  // of a server for the whole machine
}

#if defined(DANCE_HAVE_MUSIC) && defined(DANCE_HAVE_SOUND)
tl::expected<Loudspeaker, SoundFailure> find_loudspeaker() {
  auto found = default_loudspeaker("doctor");
  if (!found) return tl::make_unexpected(why_not(found.error().what));
  return std::move(*found);
}
#else
tl::expected<Loudspeaker, SoundFailure> find_loudspeaker() {
  return tl::make_unexpected(SoundFailure{SoundTrouble::kNotBuilt, "", "", false, ""});
}
#endif

Finding check_microphone(const Result<Microphone>& microphone) {
  Finding finding{"microphone", Finding::Grade::kNote, "", ""};
  if (!microphone) {
    finding.what = printable(microphone.error().what) + "; dance voice needs one to speak";
    finding.cure = "pactl list short sources   (then pactl set-default-source NAME)";
    return finding;
  }
  finding.what = printable(microphone->description);
  if (microphone->is_monitor) {
    finding.what += ": is what the loudspeaker plays; there is no microphone";
    finding.cure = "pactl list short sources   (then pactl set-default-source NAME)";
  } else if (microphone->is_muted) {
    finding.what += ": is muted";
    finding.cure = "pactl set-source-mute " + printable(microphone->name) + " 0";
  } else {
    finding.grade = Finding::Grade::kOk;
  }
  return finding;
}

#if defined(DANCE_HAVE_VOICE)
Finding check_microphone() { return check_microphone(default_microphone("doctor")); }
#else
Finding check_microphone() {
  return {"microphone", Finding::Grade::kNote, "this dance was built without voices",
          "apt-get install libopus-dev libwebrtc-audio-processing-dev libpulse-dev   (and build "
          "again)"};
}
#endif

Finding check_sound() { return check_loudspeaker(find_loudspeaker()); }

}  // namespace dance
