#include "producers/music/control/music_control.h"

#include <unistd.h>

#include "core/base/plain_number.h"
#include "core/bus/bus.h"

namespace dance {
namespace {

constexpr std::string_view kVolumeWord = "volume";

std::string music_path(const std::string& bus) {
  return control_path("music", bus_url_or_default(bus), GuestId());
}

}  // namespace

std::optional<double> parse_music_volume(std::string_view command) {
  return share_after(kVolumeWord, command);
}

Result<std::unique_ptr<MusicControl>> MusicControl::open(const std::string& bus, OnVolume on_volume,
                                                         Poller& poller) {
  auto control = ProgramControl::open(
      numbered_control_path(music_path(bus), static_cast<std::uint64_t>(getpid())),
      [on_volume = std::move(on_volume)](std::string_view command, MonoTime) {
        if (const auto volume = parse_music_volume(command)) on_volume(*volume);
      },
      poller);
  if (!control) return fail("the music cannot be told how loud to be: " + control.error().what);
  return std::unique_ptr<MusicControl>(new MusicControl(std::move(*control)));
}

bool is_music_played(const std::string& bus) {
  return !numbered_control_paths(music_path(bus)).empty();
}

Result<void> tell_music_volume(const std::string& bus, double volume) {
  DANCE_TRY(const ToldAll told,
            tell_programs(music_path(bus), std::string(kVolumeWord) + " " + plain_number(volume)));
  if (told.deaf > 0) return fail("a dance music on this bus does not listen; end it");
  if (told.sent == 0)
    return fail(
        "no music is played on this bus: a house with [music] plays it, or dance music FILE");
  return {};
}

}  // namespace dance
