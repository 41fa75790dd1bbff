#include "producers/music/control/music_control.h"

#include <unistd.h>

#include <charconv>

#include "core/base/music/music_speed.h"
#include "core/base/plain_number.h"
#include "core/bus/bus.h"

namespace dance {
namespace {

constexpr std::string_view kVolumeWord = "volume";
constexpr std::string_view kStyleWord = "style ";
constexpr std::string_view kSpeedWord = "speed ";

struct CommandWord {
  MusicCommand::What what;
  std::string_view word;
};
constexpr CommandWord kWords[] = {
    {MusicCommand::What::kNext, "next"},     {MusicCommand::What::kPlay, "play"},
    {MusicCommand::What::kPause, "pause"},   {MusicCommand::What::kSlower, "slower"},
    {MusicCommand::What::kFaster, "faster"}, {MusicCommand::What::kLock, "lock"},
    {MusicCommand::What::kUnlock, "unlock"},
};

std::string music_path(const std::string& bus) {
  return control_path("music", bus_url_or_default(bus), GuestId());
}

std::optional<double> speed_of(std::string_view text) {
  double speed = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), speed);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
  if (!(speed >= kLeastMusicSpeed && speed <= kMostMusicSpeed)) return std::nullopt;
  return speed;
}

}  // namespace

std::optional<MusicCommand> parse_music_command(std::string_view line) {
  MusicCommand command;
  if (const auto volume = share_after(kVolumeWord, line)) {
    command.volume = *volume;
    return command;
  }
  if (line.starts_with(kStyleWord)) {
    command.what = MusicCommand::What::kStyle;
    if (command.style.assign(line.substr(kStyleWord.size()))) return command;
  }
  if (line.starts_with(kSpeedWord)) {
    const auto speed = speed_of(line.substr(kSpeedWord.size()));
    if (!speed) return std::nullopt;
    command.what = MusicCommand::What::kSpeed;
    command.speed = *speed;
    return command;
  }
  for (const CommandWord& known : kWords)
    if (known.word == line) return MusicCommand{known.what};
  return std::nullopt;
}

std::string text_of(const MusicCommand& command) {
  if (command.what == MusicCommand::What::kVolume)
    return std::string(kVolumeWord) + " " + plain_number(command.volume);
  if (command.what == MusicCommand::What::kSpeed)
    return std::string(kSpeedWord) + plain_number(command.speed);
  if (command.what == MusicCommand::What::kStyle)
    return std::string(kStyleWord) + std::string(command.style.view());
  for (const CommandWord& known : kWords)
    if (known.what == command.what) return std::string(known.word);
  return "";
}

Result<std::unique_ptr<MusicControl>> MusicControl::open(const std::string& bus,
                                                         OnCommand on_command, Poller& poller) {
  auto control = ProgramControl::open(
      numbered_control_path(music_path(bus), static_cast<std::uint64_t>(getpid())),
      [on_command = std::move(on_command)](std::string_view line, MonoTime) {
        if (const auto command = parse_music_command(line)) on_command(*command);
      },
      poller);
  if (!control) return fail("the music cannot be controlled: " + control.error().what);
  return std::unique_ptr<MusicControl>(new MusicControl(std::move(*control)));
}

bool is_music_played(const std::string& bus) {
  return !numbered_control_paths(music_path(bus)).empty();
}

Result<void> send_music_command(const std::string& bus, const MusicCommand& command) {
  DANCE_TRY(const ToldAll told, tell_programs(music_path(bus), text_of(command)));
  if (told.deaf > 0) return fail("a dance music on this bus is unresponsive; end it");
  if (told.sent == 0)
    return fail(
        "no music is played on this bus: a house with [music] plays it, or dance music FILE");
  return {};
}

}  // namespace dance
