#include "research/trackers/trackers_show.h"

#include "formats/recording/log_sink.h"

namespace dance {
namespace {

constexpr float kApart_m = 1.3f;

struct Way {
  const char* guest;
  TrackerTrial trial;
};

constexpr std::array kWays{
    Way{"rules-3", {3, TrackerGuide::kGeometric}}, Way{"learned-3", {3, TrackerGuide::kLearned}},
    Way{"learned-4", {4, TrackerGuide::kLearned}}, Way{"learned-6", {6, TrackerGuide::kLearned}}};

struct Shown {
  GuestId guest;
  Skeleton skeleton;
  std::vector<Pose> poses;
};

}  // namespace

Result<void> show_trackers(const PredictTake& take, const TrackerEvalOptions& options,
                           const std::string& path) {
  std::vector<Shown> all;
  for (const Way& way : kWays) {
    TrackerShow show;
    judge_trackers(take, way.trial, options, &show);
    if (all.empty())
      all.push_back({*GuestId::parse("danced"), show.truth.skeleton, show.truth.poses});
    all.push_back({*GuestId::parse(way.guest), show.skeleton, show.solved});
  }
  DANCE_TRY(LogWriter log, LogWriter::create(path));
  LogSink sink(std::move(log), Where::kStage);
  const Eigen::Vector3f middle = all[0].poses[all[0].poses.size() / 2].p_WH_m;
  for (std::size_t i = 0; i < all[0].poses.size(); ++i)
    for (std::size_t k = 0; k < all.size(); ++k) {
      Pose pose = all[k].poses[i];
      const auto us = static_cast<std::int64_t>(1e6 * (1.0 + static_cast<double>(i) / options.hz));
      pose.capture_time = MonoTime::from_us(us);
      pose.clock_id = LogSink::kFileClockId;
      pose.sequence = static_cast<std::uint32_t>(i);
      pose.p_WH_m.x() += kApart_m * (static_cast<float>(k) - 2.0f) - middle.x();
      pose.p_WH_m.z() -= middle.z();
      sink.on_skeleton(all[k].guest, all[k].skeleton, us);
      sink.on_pose(all[k].guest, pose, us);
    }
  return sink.finish();
}

}  // namespace dance
