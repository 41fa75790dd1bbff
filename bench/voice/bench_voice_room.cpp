#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <numbers>

#include "bench/voice/bench_voice.h"
#include "bench/voice/two_houses.h"
#include "core/base/random.h"
#include "core/net/mono_clock.h"
#include "core/program/figures.h"
#include "testing/voice/room_echo.h"

namespace dance {
namespace {

constexpr int kRoomNice = -15;
constexpr Duration kRoomMost = Duration::s(60);
constexpr Duration kRoomLearns = Duration::s(5);

// Two chords and a drum, four beats of half a second.
Speech plain_music(std::size_t samples) {
  Speech music(samples);
  Random random(11);
  for (std::size_t i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i) / 48'000.0;
    const double in_beat = std::fmod(t, 0.5);
    const double root = std::fmod(t, 4.0) < 2.0 ? 220.0 : 293.7;
    double sum = 0.3 * std::exp(-20.0 * in_beat) * random.uniform(-1.0, 1.0);
    for (const double interval : {1.0, 1.25, 1.5})
      sum += 0.1 * std::sin(2.0 * std::numbers::pi * root * interval * t);
    music[i] = static_cast<float>(sum);
  }
  return music;
}

// How loud it is at alice's ear, against what is heard at a loudspeaker in bob's room.
Result<double> comes_back_db(VoiceHouses& houses, const std::string& sink, const Speech& sound,
                             const std::string& from = "ear-b") {
  SoundRooms& rooms = houses.rooms();
  DANCE_TRY(const std::size_t loudspeaker, rooms.listen(from));
  DANCE_TRY(const std::size_t ear, rooms.listen("ear-a"));
  const MonoTime begin = mono_now();
  if (auto played = rooms.play(sink, sound); !played) return tl::make_unexpected(played.error());
  houses.work_for(kRoomMost, [&] { return rooms.has_played(); });
  const Duration over = mono_now() - begin - kRoomLearns;
  const double level_db = -power_ratio_db(rooms.heard(loudspeaker, begin + kRoomLearns, over),
                                          rooms.heard(ear, begin + kRoomLearns, over));
  houses.work_for(Duration::s(1));
  return level_db;
}

}  // namespace

Result<BenchReport> bench_voice_room(const Speech& speech, const std::string& folder) {
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, kRoomNice));
  const Speech music = plain_music(speech.size());
  BenchReport report;
  report.text = fmt::format(
      "bob's microphone hears his loudspeaker, 30 ms later. comes back: at alice's ear, against "
      "that loudspeaker\n{:<24} {:>20} {:>20} {:>20}\n",
      "cancellation", "alice's own voice", "music in bob's room", "of another sink");
  struct Way {
    const char* name;
    bool is_on;
    const char* reference;
  };
  for (const Way& way :
       {Way{"off", false, ""}, Way{"on", true, ""}, Way{"on, --reference", true, "music-b"}}) {
    VoiceHouses houses(folder);
    VoiceHouses::Options options;
    options.bob_hears_his_loudspeaker = true;
    options.voice_words = {"--no-cleaning"};
    if (!way.is_on) options.voice_words.emplace_back("--no-echo-cancellation");
    if (*way.reference != '\0')
      options.voice_words.push_back("--reference=" + std::string(way.reference));
    if (auto started = houses.start(options); !started) return tl::make_unexpected(started.error());
    DANCE_TRY(const double voice_db, comes_back_db(houses, "mouth-a", speech));
    DANCE_TRY(const double music_db, comes_back_db(houses, "ear-b", music));
    DANCE_TRY(const double other_db, comes_back_db(houses, "music-b", music, "music-b"));
    report.text += fmt::format("{:<24} {:>17.1f} dB {:>17.1f} dB {:>17.1f} dB\n", way.name,
                               voice_db, music_db, other_db);
    report.json.push_back({{"cancellation", way.is_on},
                           {"reference", way.reference},
                           {"voice_comes_back_db", rounded(voice_db, 10.0)},
                           {"music_comes_back_db", rounded(music_db, 10.0)},
                           {"music_of_another_sink_comes_back_db", rounded(other_db, 10.0)}});
  }
  return report;
}

}  // namespace dance
