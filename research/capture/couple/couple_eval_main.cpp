// dance capture couple eval: two dancers before one camera, drawn from recorded takes.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/program/command_line.h"
#include "core/program/figures.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "research/capture/couple/couple_eval.h"

namespace dance {
namespace {

constexpr const char* kCoupleExamples = R"(Examples:
  dance capture couple eval lead.bvh follow.bvh --avatar teo.vrm,marisol.vrm
  dance capture couple eval lead.bvh follow.bvh --yaw 0,90 --pictures out/couple --json
Pairs of takes follow each other: LEAD FOLLOW LEAD FOLLOW. Both are drawn as avatars by the viewer's
renderer, and the real networks see the pictures.
  right      frames outside of full occlusion (7 of 10 joints behind the partner) in which a dancer
             is found and is the right one; longest: how long an identity was wrong at most
  separate   the baseline: two estimators, each told at first where its dancer is
  wrists     of the shown body, the middle of the hips removed, two seconds later on: of each dancer
             drawn alone, and of both together; in hold: a wrist within 25 cm of the partner's
)";

struct CoupleEvalWishes {
  std::vector<std::string> files;
  std::vector<std::string> avatars;
  std::vector<double> yaws{0.0};
  double hz = 30.0;
  double from_s = 0.0, seconds = 0.0;
  double distance_m = 4.2;
  std::string pictures, log;
  PoseNetworkModel model = PoseNetworkModel::kFull;
  bool is_json = false;
  bool is_quick = false;
};

nlohmann::ordered_json json_of(const IdentityFigures& f) {
  return {{"right_percent", rounded(f.right_percent(), 1000.0)},
          {"wrong_frames", f.wrong},
          {"missing_frames", f.missing},
          {"frames", f.frames},
          {"longest_wrong_s", rounded(f.longest_wrong_s, 100.0)}};
}
nlohmann::ordered_json json_of(const WristFigures& f) {
  return {{"wrists_mm", rounded(f.all_mm, 10.0)},
          {"wrists_in_hold_mm", rounded(f.in_hold_mm, 10.0)},
          {"wrists_in_hold_median_mm", rounded(f.in_hold_median_mm, 10.0)},
          {"hips_mm", rounded(f.hips_mm, 10.0)}};
}
nlohmann::ordered_json json_of(const CoupleScore& s) {
  return {{"name", s.name},
          {"separate", json_of(s.separate)},
          {"people", json_of(s.people)},
          {"alone", json_of(s.alone)},
          {"together", json_of(s.together)},
          {"exchanged", s.counters.exchanged},
          {"reassigned", s.counters.reassigned},
          {"duplicates", s.counters.duplicates},
          {"limbs_hidden", s.counters.limbs_hidden},
          {"searches", s.counters.searches},
          {"processor_ms_median", rounded(s.ms_median, 100.0)},
          {"processor_ms_p95", rounded(s.ms_p95, 100.0)},
          {"alone_processor_ms_median", rounded(s.alone_ms_median, 100.0)}};
}

void print_identities(const char* name, const IdentityFigures& f) {
  fmt::print("    {:<10} {:>8.2f} {:>7} {:>8} {:>10.2f}\n", name, f.right_percent(), f.wrong,
             f.missing, f.longest_wrong_s);
}
void print_wrists(const char* name, const WristFigures& f) {
  fmt::print("    {:<10} {:>8.1f} {:>8.1f} {:>8.1f} {:>8.1f}\n", name, f.all_mm, f.in_hold_mm,
             f.in_hold_median_mm, f.hips_mm);
}
void print(const CoupleScore& s) {
  fmt::print("  {} ({} frames of a dancer)\n", s.name, s.people.frames);
  fmt::print("                right %   wrong  missing  longest s\n");
  print_identities("separate", s.separate);
  print_identities("people", s.people);
  fmt::print("              wrists mm  in hold   median  hips mm\n");
  print_wrists("alone", s.alone);
  print_wrists("together", s.together);
  fmt::print(
      "    in hold {:.2f} times alone; {} exchanged back, {} reassigned, {} on one body, {} limbs "
      "given to the other, {} searches\n",
      s.alone.in_hold_mm > 0.0 ? s.together.in_hold_mm / s.alone.in_hold_mm : 0.0,
      s.counters.exchanged, s.counters.reassigned, s.counters.duplicates, s.counters.limbs_hidden,
      s.counters.searches);
  fmt::print("    processor: both {:.1f} ms, p95 {:.1f}; one alone {:.1f}\n", s.ms_median, s.ms_p95,
             s.alone_ms_median);
}

Result<void> evaluate(const CoupleEvalWishes& wishes) {
  if (wishes.files.size() % 2 != 0) return fail("takes come in pairs: LEAD FOLLOW");
  if (!wishes.avatars.empty() && wishes.avatars.size() != 2)
    return fail("--avatar: two files, the lead's and the follow's");
  CoupleWishes how;
  how.log = wishes.log;
  how.has_baseline = !wishes.is_quick;
  how.model = wishes.model;
  how.first_frame = static_cast<std::size_t>(wishes.from_s * wishes.hz);
  if (wishes.seconds > 0.0) how.most_frames = static_cast<std::size_t>(wishes.seconds * wishes.hz);
  std::vector<CoupleScore> scores;
  for (std::size_t i = 0; i + 1 < wishes.files.size(); i += 2) {
    DANCE_TRY(const CodecTake lead, load_codec_take(wishes.files[i], wishes.hz));
    DANCE_TRY(const CodecTake follow, load_codec_take(wishes.files[i + 1], wishes.hz));
    for (const double yaw : wishes.yaws) {
      CoupleView view;
      view.yaw_deg = yaw;
      view.distance_m = wishes.distance_m;
      view.pictures = wishes.pictures;
      if (!wishes.avatars.empty()) view.avatar = {wishes.avatars[0], wishes.avatars[1]};
      DANCE_TRY(auto couple, DrawnCouple::open(lead, follow, view));
      DANCE_TRY(const CoupleScore score, evaluate_couple(*couple, how));
      scores.push_back(score);
      if (!wishes.is_json) print(score);
    }
  }
  if (wishes.is_json) {
    nlohmann::ordered_json json{{"each", nlohmann::ordered_json::array()}};
    for (const CoupleScore& score : scores) json["each"].push_back(json_of(score));
    json["all"] = json_of(all_of(scores));
    std::printf("%s\n", json.dump(2).c_str());
  } else if (scores.size() > 1) {
    print(all_of(scores));
  }
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::CoupleEvalWishes wishes;
  dance::CommandLine line(
      "Two dancers before one camera, drawn from recorded takes: who is taken for whom, and how "
      "well they are shown.",
      "dance capture couple eval");
  line.add("TAKE", wishes.files, "BVH files of couples, also packed with xz: LEAD FOLLOW …")
      .required();
  line.add("--avatar", wishes.avatars,
           "what lead and follow are drawn as, LEAD,FOLLOW; mannequins without it")
      .split_at(',');
  line.add("--yaw", wishes.yaws, "degrees from which the camera looks, as 0,90").split_at(',');
  line.add("--hz", wishes.hz, "pictures a second").range(5, 60).shows_default();
  line.add("--from", wishes.from_s, "seconds of the takes that are left out").range(0, 3600);
  line.add("--seconds", wishes.seconds, "how many of each; 0 = all").range(0, 3600);
  line.add("--distance", wishes.distance_m, "metres from the camera to the middle of the dance")
      .range(1, 20)
      .shows_default();
  line.add("--pictures", wishes.pictures, "a folder that keeps the pictures for the next run");
  line.add("--log", wishes.log, "a file that gets a line for each picture");
  line.add_choice<dance::PoseNetworkModel>("--model", wishes.model,
                                           {{"lite", dance::PoseNetworkModel::kLite},
                                            {"full", dance::PoseNetworkModel::kFull},
                                            {"heavy", dance::PoseNetworkModel::kHeavy}},
                                           "size of the pose network");
  line.add_flag("--quick", wishes.is_quick, "without the baseline of two programs");
  line.add_flag("--json", wishes.is_json, "one JSON object on stdout");
  line.footer(dance::kCoupleExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::evaluate(wishes); });
}
