#include "house/house_music.h"

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr Duration kMusicLook = Duration::ms(200);
constexpr Duration kMusicEnds = Duration::s(2);

}  // namespace

std::vector<std::string> music_arguments(const HostedMusic& music, const std::string& bus) {
  std::vector<std::string> words{"--bus", bus};
  const auto add = [&](const char* option, const std::string& value) {
    words.emplace_back(option);
    words.push_back(value);
  };
  if (music.guest.is_set()) add("--guest", std::string(music.guest.view()));
  if (music.is_alone) words.emplace_back("--alone");
  if (music.follow) words.emplace_back("--follow");
  if (music.loop) words.emplace_back("--loop");
  if (music.silent) words.emplace_back("--silent");
  if (music.microphone) words.emplace_back("--microphone");
  if (!music.band.empty()) add("--band", music.band);
  if (!music.beats.empty()) add("--beats", music.beats);
  if (music.volume != 1.0) add("--volume", std::to_string(music.volume));
  if (music.trim_ms != 0.0) add("--trim", std::to_string(music.trim_ms) + "ms");
  if (music.steps_bpm != 0.0) add("--steps", std::to_string(music.steps_bpm));
  // Behind a mark, as a file's name may begin with a dash.
  words.emplace_back("--");
  if (!music.file.empty()) words.push_back(music.file);
  return words;
}

Result<std::unique_ptr<HouseMusic>> HouseMusic::open(const HostedMusic& music,
                                                     const std::string& bus, Poller& poller) {
  DANCE_TRY(ChildProcess program, ChildProcess::start({program_folder() + "/dance-music",
                                                       music_arguments(music, bus), "", ""}));
  return std::unique_ptr<HouseMusic>(new HouseMusic(std::move(program), poller));
}

HouseMusic::HouseMusic(ChildProcess program, Poller& poller)
    : program_(std::move(program)),
      poller_(poller),
      watch_(poller.add_timer(mono_now() + kMusicLook, [this](MonoTime now) {
        if (!program_.has_ended()) return now + kMusicLook;
        if (program_.ended_well())
          talk::info("the music is over");
        else
          talk::warn("the music {}; the house goes on without it", program_.exit_text());
        return MonoTime();
      })) {}

HouseMusic::~HouseMusic() {
  poller_.set_deadline(watch_, MonoTime());
  program_.stop(kMusicEnds);
}

}  // namespace dance
