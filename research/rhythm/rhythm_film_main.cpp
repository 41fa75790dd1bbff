// dance rhythm film: a recorded couple over a line, shown in several ways side by side, as a log.
#include <optional>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "formats/recording/log_sink.h"
#include "producers/music/beats_file.h"
#include "research/predict_model_file.h"
#include "research/rhythm/couple_film.h"
#include "transformers/settings.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance rhythm film lead.bvh follow.bvh -o couple.lcm
  dance rhythm film lead.bvh follow.bvh --beats song.beats --delay 120ms -o couple.lcm
  dance view --log couple.lcm

The first dances here, the second comes over the line. The log holds the couple several times, from
left to right: poses as they come (raw), predicted alone, predicted beside the partner, with --beats
on the beat by rhythm beats=auto, and as they really danced.
)";

struct Wishes {
  std::string here, remote, beats, delay = "200ms", jitter = "0ms", model, out = "couple.lcm";
  FilmOptions film;
};

// All who dance here look alike, and all remote dancers; said once a second, as houses do.
class DressedSink : public RecordingSink {
 public:
  DressedSink(LogSink& log, const std::vector<FilmedWay>& ways) : log_(log), ways_(ways) {
    here_.name = *AvatarName::parse("trousers-crop-tee");
    here_.colour_rgb = {0.25f, 0.45f, 0.85f};
    remote_.name = *AvatarName::parse("dress-bun-bare");
    remote_.colour_rgb = {0.9f, 0.3f, 0.3f};
  }
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t us) override {
    log_.on_skeleton(guest, skeleton, us);
  }
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t us) override {
    dress(us);
    log_.on_pose(guest, pose, us);
  }
  void on_hands(const GuestId& guest, const Hands& hands, std::int64_t us) override {
    log_.on_hands(guest, hands, us);
  }
  void on_beat(const Beat& beat, std::int64_t us) override { log_.on_beat(beat, us); }

 private:
  void dress(std::int64_t us) {
    constexpr std::int64_t kAgain_us = 1'000'000;
    if (us < next_us_) return;
    next_us_ = us + kAgain_us;
    for (const FilmedWay& way : ways_) {
      log_.on_avatar(here_of(way), here_, us);
      log_.on_avatar(remote_of(way), remote_, us);
    }
  }

  LogSink& log_;
  const std::vector<FilmedWay>& ways_;
  Avatar here_, remote_;
  std::int64_t next_us_ = 0;
};

Result<void> run(Wishes wishes) {
  DANCE_TRY(wishes.film.delay, parse_duration(wishes.delay));
  DANCE_TRY(wishes.film.jitter, parse_duration(wishes.jitter));
  std::optional<BeatGrid> music;
  if (!wishes.beats.empty()) {
    DANCE_TRY(music, read_beats_file(wishes.beats));
  }
  DANCE_TRY(const CodecTake here, load_codec_take(wishes.here, wishes.film.hz));
  DANCE_TRY(const CodecTake remote, load_codec_take(wishes.remote, wishes.film.hz));
  DANCE_TRY(const FlowParts parts, parts_with_model(wishes.model));
  BeatDance dances[2];
  if (music) {
    // One music for both.
    const std::vector<SeenSteps> steps{steps_of(here.skeleton, here.poses, here.hz),
                                       steps_of(remote.skeleton, remote.poses, remote.hz)};
    const DanceBeats beats = find_dance_beats(steps);
    dances[0] = lay_onto_beats(here, beats, *music, wishes.film.hz);
    dances[1] = lay_onto_beats(remote, beats, *music, wishes.film.hz);
  } else {
    for (std::size_t d = 0; d < 2; ++d)
      dances[d] = as_danced(d == 0 ? here : remote, wishes.film.hz);
  }
  DANCE_TRY(LogWriter log, LogWriter::create(wishes.out));
  LogSink sink(std::move(log), Where::kStage);
  const auto ways = usual_ways(music.has_value());
  DressedSink dressed(sink, ways);
  if (auto filmed = film_couple(dances[0], dances[1], music ? &*music : nullptr, ways, wishes.film,
                                parts, dressed);
      !filmed)
    return filmed;
  if (auto finished = sink.finish(); !finished) return finished;
  talk::info("{}: {} events; dance view --log {}", wishes.out, sink.events(), wishes.out);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line(
      "A recorded couple over a line, shown in several ways side by side, as a log.",
      "dance rhythm film");
  line.add("HERE", wishes.here, "BVH file of the one who dances in this house").required();
  line.add("REMOTE", wishes.remote, "of the same dance, the one who comes over the line")
      .required();
  line.add("-o,--out", wishes.out, "where the log goes; a file that is there is refused")
      .shows_default();
  line.add("--beats", wishes.beats, "beats of a song: both dance to it");
  line.add("--delay", wishes.delay, "of the line").shows_default();
  line.add("--jitter", wishes.jitter, "mean of what is added to the delay").shows_default();
  line.add("--loss", wishes.film.loss_percent, "percent of the poses that are lost")
      .range(0.0, 90.0);
  line.add("--noise", wishes.film.noise_deg, "degrees that each bone trembles by, as sensors do")
      .range(0.0, 10.0);
  line.add("--seed", wishes.film.seed, "another number, other noise and losses").shows_default();
  line.add("--model", wishes.model, "a model of dance predict train instead of the built-in one");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(std::move(wishes)); });
}
