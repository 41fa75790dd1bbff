// dance stage eval: a recorded couple on avatars: hands, feet, wrists, smoothness, cost.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/stage/stage_eval.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance stage eval lead.bvh.xz follow.bvh.xz --avatar mannequin:1.9 --avatar mannequin:1.5
  dance stage eval lead.bvh.xz follow.bvh.xz --avatar robot.vrm --avatar woman.glb --json
  dance stage eval night.lcm --avatar robot.vrm
  dance stage eval lead.bvh.xz follow.bvh.xz --avatar child.glb --own-size
  dance stage eval lead.bvh.xz follow.bvh.xz --avatar robot.vrm --join 0.3
The first avatar is for the first dancer and so on; the last one is for those who remain. Measured
on what is drawn, beside a plain retargeting without feet, hands and twist ("plain"). Meetings:
moments at which palms of two dancers are within 3 cm; hand_gap is the avatars' then. hold_off: by
how much a palm is elsewhere, seen from the partner's palm, while they are within 8 cm. A standing
foot's sole is within 3 cm of the floor in the recording and slower than 0.15 m/s; foot_floor is
how far the avatar's is from the floor. joint_step: what a joint moves from frame to frame besides
what the dancer's does.
)";

struct Wishes {
  std::vector<std::string> files, avatars;
  double hz = 60.0, height_scale = 1.0, join_m = 0.0;
  bool own_size = false, json = false;
};

Result<void> run(const Wishes& wishes) {
  DANCE_TRY(StageTake take, load_stage_take(wishes.files, wishes.hz));
  join_hands(take, static_cast<float>(wishes.join_m));
  StageWear wear;
  wear.size = wishes.own_size ? FigureSize::kOwn : FigureSize::kDancers;
  wear.height_scale = static_cast<float>(wishes.height_scale);
  for (std::size_t d = 0; d < take.dancers.size(); ++d) {
    const std::string name = wishes.avatars.empty()
                                 ? "mannequin"
                                 : wishes.avatars[std::min(d, wishes.avatars.size() - 1)];
    DANCE_TRY(auto avatar, load_stage_avatar(name, take.dancers[d].clip.skeleton));
    wear.avatars.push_back(std::move(avatar));
  }
  const StageEval eval = evaluate_stage(take, wear);
  const std::string text = wishes.json ? stage_eval_json(eval) : stage_eval_table(eval);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line("A recorded couple on avatars: do hands meet, do feet stand?",
                          "dance stage eval");
  line.add("FILE", wishes.files, "BVH files, also packed with xz, glTF files or logs").required();
  line.add("--avatar", wishes.avatars,
           "a .vrm or .glb; mannequin: the dancer's own; mannequin:1.1: one 1.1 m tall");
  line.add("--hz", wishes.hz, "poses a second").range(10.0, 240.0).shows_default();
  line.add("--height-scale", wishes.height_scale, "times the size that avatars have otherwise")
      .range(dance::kLeastHeightScale, dance::kMostHeightScale)
      .shows_default();
  line.add("--join", wishes.join_m,
           "metres: palms of two dancers nearer than this are first brought together in the "
           "recording, as many a motion capture does not")
      .range(0.0, 0.6);
  line.add_flag("--own-size", wishes.own_size,
                "avatars keep their size; else their legs are as long as the dancers'");
  line.add_flag("--json", wishes.json, "one JSON object on stdout");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
