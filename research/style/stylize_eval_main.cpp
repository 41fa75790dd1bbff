// dance stylize eval: what the station `stylize` does to recorded dances.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/style/stylize_eval.h"
#include "research/style/stylize_overview.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance stylize eval salsa.bvh --zone hips --gain 1.5
  dance stylize eval *.bvh.xz --zone arms --gain 2 --mix 0 --json
  dance stylize eval --synthetic --zone hips --gain 0.5 --mix 0
  dance stylize eval salsa.bvh --zone shoulders --gain 1.3 --untagged
  dance stylize eval salsa.bvh --mix 0 --tempo-off 9
  dance stylize eval *.bvh.xz --overview --gain 1.5
  dance stylize eval *.bvh.xz --overview --gain 1.5 --joined
Gains are measured by least squares at the harmonics of the bar over the whole take, not by the
filters of the transformer itself. Hips: their tilt and their sway over the feet; the legs are
solved anew, so the feet's places are what must not change. Others: the largest change of a bone of
another zone, in degrees. Swing: the gain of legs while their foot is in the air; slide: of the
balls of feet that stand, mm/s, and as danced.
)";

struct Wishes {
  std::vector<std::string> files;
  StylizeEvalOptions eval;
  double hz = 60.0, noise_deg = 0.0, tempo_off_percent = 0.0;
  bool synthetic = false, joined = false, overview = false, json = false;
};

std::string report_of(const std::vector<StyleTake>& takes, const Wishes& wishes) {
  std::vector<StylizeEval> evals;
  for (const StyleTake& take : takes) evals.push_back(evaluate_stylize(take, wishes.eval));
  const StylizeEval all = sum_up(evals);
  return wishes.json ? stylize_eval_json(all, evals, wishes.eval)
                     : stylize_eval_table(all, evals, wishes.eval);
}

std::string overview_of(const std::vector<StyleTake>& takes, const Wishes& wishes) {
  const std::vector<StylizeRow> rows = stylize_overview(takes, wishes.eval);
  return wishes.json ? stylize_overview_json(rows) : stylize_overview_table(rows);
}

Result<void> run(Wishes wishes) {
  std::vector<StyleTake> takes;
  if (wishes.synthetic) takes.push_back(synthetic_sway(wishes.hz));
  for (const std::string& file : wishes.files) {
    DANCE_TRY(const CodecTake take, load_codec_take(file, wishes.hz, wishes.noise_deg));
    takes.push_back(style_take_of(take, wishes.tempo_off_percent));
  }
  if (wishes.joined) takes = joined(takes);
  if (takes.empty()) return fail("nobody dances: name BVH files, or --synthetic");
  for (const StyleTake& take : takes) {
    const double length_s = static_cast<double>(take.poses.size()) / take.hz;
    if (length_s < wishes.eval.warm_up_s + 4.0)
      return fail(take.name + " is too short to measure after a warm-up of " +
                  std::to_string(wishes.eval.warm_up_s) + " s: give --warm-up less");
  }
  const std::string text = wishes.overview ? overview_of(takes, wishes) : report_of(takes, wishes);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line("Stylized dances against themselves: gain, mean pose, bones, feet.",
                          "dance stylize eval");
  line.add("FILE", wishes.files, "BVH files, also packed with xz");
  std::vector<dance::Choice<dance::BodyZone>> choices;
  for (std::size_t z = 0; z < dance::kBodyZones; ++z)
    choices.push_back({dance::kZoneNames[z].data(), static_cast<dance::BodyZone>(z)});
  line.add_choice("--zone", wishes.eval.zone, choices, "whose gain").shows_default();
  line.add("--gain", wishes.eval.gain, "0 nothing of it, 1 as danced")
      .range(0.0, 4.0)
      .shows_default();
  line.add("--mix", wishes.eval.mix, "0: what comes again with each bar alone; 1: all of it")
      .range(0.0, 1.0)
      .shows_default();
  line.add("--hz", wishes.hz, "poses a second").range(10.0, 240.0).shows_default();
  line.add("--noise", wishes.noise_deg,
           "degrees by which each bone of a file trembles from pose to pose, as sensors do")
      .range(0.0, 20.0);
  line.add("--warm-up", wishes.eval.warm_up_s, "seconds that are not measured")
      .range(0.0, 600.0)
      .shows_default();
  line.add_flag("--synthetic", wishes.synthetic, "two minutes of known sway, too");
  line.add_flag("--joined", wishes.joined,
                "files of one dancer that follow each other are one long dance, as a song is");
  line.add("--tempo-off", wishes.tempo_off_percent,
           "percent by which the music that takes are told is faster: what is found then is chance")
      .range(-30.0, 30.0);
  line.add_flag("--untagged", wishes.eval.untagged,
                "poses come without musical time: the bar is found in the motion");
  line.add_flag("--overview", wishes.overview,
                "all zones at mix 0, 0.5 and 1: one row each, over all takes");
  line.add_flag("--json", wishes.json, "one JSON object on stdout");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
