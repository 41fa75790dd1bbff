#include "research/beats/step_dancers.h"

#include <cmath>

#include "core/pose/interpolate.h"

namespace dance {
namespace {

constexpr double kTakes_hz = 60.0;
// A take is danced over again after whole figures of so many beats.
constexpr double kFigure_beats = 8.0;
// The clock of the evaluation has no zero of its own.
constexpr MonoTime kSongBegin = MonoTime::from_us(1'000'000'000);

void dance_beat(const UntaggedTake& dancer, double beat, Pose& pose) {
  const CodecTake& take = dancer.take;
  const double last_s = static_cast<double>(take.poses.size() - 1) / take.hz;
  const double first = std::ceil(dancer.beats.beats_at(0.0));
  const double last = dancer.beats.beats_at(last_s);
  const double round = kFigure_beats * std::floor((last - first) / kFigure_beats);
  const double at = first + beat - round * std::floor(beat / round);
  const double frame = std::clamp(dancer.beats.time_of(at), 0.0, last_s) * take.hz;
  const auto whole = std::min(static_cast<std::size_t>(frame), take.poses.size() - 2);
  pose = interpolate(take.poses[whole], take.poses[whole + 1],
                     static_cast<float>(frame - static_cast<double>(whole)));
}

}  // namespace

Result<std::shared_ptr<const StepTakes>> load_step_takes(const std::vector<std::string>& files) {
  DANCE_TRY(StepTakes takes, load_untagged_takes(files, true, kTakes_hz));
  return std::make_shared<const StepTakes>(std::move(takes));
}

StepDancers::StepDancers(const StepTakes& takes, std::size_t couple)
    : partners_{&takes[couple % (takes.size() / 2)],
                &takes[takes[couple % (takes.size() / 2)].partner]} {}

bool StepDancers::dance_until(double song_s, const BeatGrid& song, double speed, double start_s,
                              const Beat& told) {
  bool is_judged = false;
  for (; poses_ / kPose_hz <= song_s; ++poses_) {
    const double s = poses_ / kPose_hz;
    now_ = kSongBegin + Duration::seconds(s);
    const double beat = song.beat_at(s * speed + start_s);
    for (std::size_t who = 0; who < 2; ++who) {
      dance_beat(*partners_[who], beat, pose_);
      pose_.capture_time = now_;
      pose_.clock_id = 1;
      room_.observe(RoomSteps::Whose::kOwn, *GuestId::parse(who == 0 ? "alice" : "bob"), pose_,
                    now_);
    }
    if (poses_ % kPosesAJudgement != 0) continue;
    Beat heard = told;
    heard.time = heard.beat_time = now_;
    if (is_valid(heard)) room_.hear(heard);
    if (const auto steps = room_.pass(now_)) hint_.hear(*steps, now_);
    is_judged = true;
  }
  return is_judged;
}

}  // namespace dance
