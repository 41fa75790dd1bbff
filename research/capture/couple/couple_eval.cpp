#include "research/capture/couple/couple_eval.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/program/figures.h"
#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/solver/body_solver.h"
#include "research/capture/thread_time.h"

namespace dance {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFullyHidden = 0.7;
constexpr std::size_t kWarmUp = 60;  // frames in which the solver learns bones and floor

double thread_ms() { return 1e-6 * static_cast<double>(thread_time_ns()); }

using JointPlaces_px = std::array<Vector2d, kJudgedCount>;

JointPlaces_px places_px(const BodyLandmarks& seen) {
  JointPlaces_px places;
  for (std::size_t j = 0; j < kJudgedCount; ++j)
    places[j] = seen.image(kLimbJoints[j].landmark).head<2>().cast<double>();
  return places;
}

// The mean distance of a body's joints in the picture, sides exchanged where that is nearer: a back
// that is taken for a front is still the same person's.
double distance_px(const BodyLandmarks& seen, const JointPlaces_px& reference) {
  const JointPlaces_px places = places_px(seen);
  double straight = 0.0, exchanged = 0.0;
  for (std::size_t j = 0; j < kJudgedCount; ++j) {
    straight += (places[j] - reference[j]).norm();
    exchanged += (places[j] - reference[j ^ 1]).norm();
  }
  return std::min(straight, exchanged) / static_cast<double>(kJudgedCount);
}

// Where the network sees each of the two who is drawn alone: what is off of a dancer there is off
// beside the partner, too, and says nothing of who it is.
using References = std::array<JointPlaces_px, 2>;

class IdentityJudge {
 public:
  explicit IdentityJudge(double hz) : hz_(hz) {}
  void judge(const CoupleTruth& truth, const References& alone, std::size_t person,
             const BodyLandmarks& seen) {
    const bool is_wrong =
        seen.found && distance_px(seen, alone[1 - person]) < distance_px(seen, alone[person]);
    wrong_run_[person] = is_wrong ? wrong_run_[person] + 1 : 0;
    if (truth.hidden[person] >= kFullyHidden) return;
    ++figures_.frames;
    ++(seen.found ? is_wrong ? figures_.wrong : figures_.right : figures_.missing);
    figures_.longest_wrong_s =
        std::max(figures_.longest_wrong_s, static_cast<double>(wrong_run_[person]) / hz_);
  }
  const IdentityFigures& figures() const { return figures_; }

 private:
  double hz_;
  std::array<int, 2> wrong_run_{};
  IdentityFigures figures_;
};

double percentile_of(std::vector<double> values, double fraction) {
  std::sort(values.begin(), values.end());
  return percentile<double>(values, fraction);
}

// A mean over `frames`, and one over `more`, become one over both.
void merge(double& mean, std::size_t frames, double other, std::size_t more) {
  if (more == 0) return;
  mean = (mean * static_cast<double>(frames) + other * static_cast<double>(more)) /
         static_cast<double>(frames + more);
}

void add(WristFigures& sum, const WristFigures& more) {
  merge(sum.all_mm, sum.frames, more.all_mm, more.frames);
  merge(sum.hips_mm, sum.frames, more.hips_mm, more.frames);
  merge(sum.in_hold_median_mm, sum.frames_in_hold, more.in_hold_median_mm, more.frames_in_hold);
  merge(sum.in_hold_mm, sum.frames_in_hold, more.in_hold_mm, more.frames_in_hold);
  sum.frames += more.frames;
  sum.frames_in_hold += more.frames_in_hold;
}

// A dancer's shown bodies against the truth.
class WristJudge {
 public:
  void judge(const CoupleTruth& truth, std::size_t person, const Skeleton& skeleton,
             const Pose& pose) {
    BodyFrames frames;
    forward_kinematics(skeleton, pose, frames);
    const LimbPlaces shown = limb_places(frames);
    const auto& is = truth.joint_W_m[person];
    const Vector3d shown_hips = middle_of_hips(shown), hips = middle_of_hips(is);
    for (std::size_t j = kWristsAt; j < kHipsAt; ++j) {
      const double off = 1e3 * ((shown[j] - shown_hips) - (is[j] - hips)).norm();
      all_.push_back(off);
      if (truth.is_in_hold) in_hold_.push_back(off);
    }
    hips_.push_back(shown_hips - hips);
  }
  WristFigures figures() const {
    const auto mean = [](const std::vector<double>& values) {
      double sum = 0.0;
      for (const double v : values) sum += v;
      return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
    };
    Vector3d offset = Vector3d::Zero();
    for (const Vector3d& p : hips_) offset += p / static_cast<double>(hips_.size());
    std::vector<double> off;
    for (const Vector3d& p : hips_) off.push_back(1e3 * (p - offset).norm());
    WristFigures figures;
    figures.all_mm = mean(all_);
    figures.hips_mm = mean(off);
    figures.in_hold_mm = mean(in_hold_);
    figures.in_hold_median_mm = percentile_of(in_hold_, 0.5);
    figures.frames = all_.size();
    figures.frames_in_hold = in_hold_.size();
    return figures;
  }

 private:
  std::vector<double> all_, in_hold_;
  std::vector<Vector3d> hips_;
};

class Evaluation {
 public:
  Evaluation(DrawnCouple& couple, const CoupleWishes& wishes) : couple_(couple), wishes_(wishes) {
    end_ = std::min(couple.frames(), wishes.first_frame + wishes.most_frames);
    references_.resize(std::max(end_, wishes.first_frame) - wishes.first_frame);
    networks_.model = wishes.model;
    score_.name = couple.name();
  }

  Result<CoupleScore> run() {
    for (std::size_t i = 0; i < 2; ++i)
      if (auto done = run_alone(i); !done) return tl::make_unexpected(done.error());
    if (auto done = run_people(); !done) return tl::make_unexpected(done.error());
    if (!wishes_.has_baseline) return score_;
    if (auto done = run_separate(); !done) return tl::make_unexpected(done.error());
    return score_;
  }

 private:
  MonoTime time_of(std::size_t f) const {
    return MonoTime() + Duration::seconds(1.0 + static_cast<double>(f) / couple_.hz());
  }
  Result<Frame> frame_of(std::size_t f, DrawnCouple::Who who) {
    DANCE_TRY(const cv::Mat image, couple_.picture(f, who));
    Frame frame;
    frame.image = image;
    frame.capture_time = frame.fetched = time_of(f);
    frame.sequence = f;
    return frame;
  }
  const References& references(std::size_t f) const { return references_[f - wishes_.first_frame]; }
  // Who is who is said by the first picture with anybody: number 0 is whom that body is nearer to.
  void number(const References& alone, std::span<const BodyLandmarks> bodies) {
    if (is_numbered_) return;
    for (std::size_t p = 0; p < 2; ++p) {
      if (!bodies[p].found) continue;
      const bool is_lead = distance_px(bodies[p], alone[0]) < distance_px(bodies[p], alone[1]);
      is_exchanged_ = is_lead != (p == 0);
      is_numbered_ = true;
      return;
    }
  }
  std::size_t person_of(std::size_t number) const { return is_exchanged_ ? 1 - number : number; }

  Result<void> run_people() {
    PeopleOptions options;
    options.people = 2;
    DANCE_TRY(auto estimator, PeopleEstimator::open(networks_, options));
    std::vector<BodySolver> solvers;
    const auto shared = make_shared_placement();
    for (int i = 0; i < 2; ++i) solvers.emplace_back(SolverOptions{}, couple_.pinhole(), shared);
    IdentityJudge identities(couple_.hz());
    std::array<WristJudge, 2> wrists;
    std::vector<double> times;
    std::ofstream log;
    if (!wishes_.log.empty()) log.open(wishes_.log, std::ios::app);
    for (std::size_t f = wishes_.first_frame; f < end_; ++f) {
      DANCE_TRY(const Frame frame, frame_of(f, DrawnCouple::Who::kBoth));
      const double begin = thread_ms();
      const auto bodies = estimator->estimate(frame);
      const CoupleTruth& truth = couple_.truth(f);
      number(references(f), bodies);
      std::array<Pose, 2> poses;
      std::array<bool, 2> is_shown{};
      for (std::size_t p = 0; p < 2; ++p)
        is_shown[p] = solvers[p].solve(bodies[p], std::nullopt, poses[p]);
      times.push_back(thread_ms() - begin);
      for (std::size_t p = 0; p < 2; ++p) {
        const std::size_t person = person_of(p);
        identities.judge(truth, references(f), person, bodies[p]);
        if (is_shown[p] && f >= wishes_.first_frame + kWarmUp)
          wrists[person].judge(truth, person, solvers[p].skeleton(), poses[p]);
      }
      if (!log) continue;
      write_log(log, f, truth, bodies, estimator->tracker().counters());
      for (std::size_t p = 0; p < 2; ++p)
        if (is_shown[p]) write_place(log, truth, person_of(p), solvers[p].skeleton(), poses[p]);
      log << '\n';
    }
    score_.people = identities.figures();
    for (const WristJudge& judge : wrists) add(score_.together, judge.figures());
    score_.counters = estimator->tracker().counters();
    score_.ms_median = percentile_of(times, 0.5);
    score_.ms_p95 = percentile_of(times, 0.95);
    return {};
  }

  void write_log(std::ofstream& log, std::size_t f, const CoupleTruth& truth,
                 std::span<const BodyLandmarks> bodies, const PeopleCounters& counters) {
    log << fmt::format("{} hidden {:.2f} {:.2f} hold {}", f, truth.hidden[0], truth.hidden[1],
                       truth.is_in_hold ? 1 : 0);
    for (std::size_t p = 0; p < 2; ++p) {
      const std::size_t person = person_of(p);
      if (bodies[p].found)
        log << fmt::format("  {}: own {:.0f} other {:.0f}{}", person,
                           distance_px(bodies[p], references(f)[person]),
                           distance_px(bodies[p], references(f)[1 - person]),
                           bodies[p].is_new ? " new" : "");
      else
        log << fmt::format("  {}: -", person);
    }
    log << fmt::format("  s {} d {} x {} r {} l {}", counters.searches, counters.duplicates,
                       counters.exchanged, counters.reassigned, counters.limbs_hidden);
  }

  // How far off the shown hips are, in metres.
  static void write_place(std::ofstream& log, const CoupleTruth& truth, std::size_t person,
                          const Skeleton& skeleton, const Pose& pose) {
    BodyFrames frames;
    forward_kinematics(skeleton, pose, frames);
    const Vector3d off =
        middle_of_hips(limb_places(frames)) - middle_of_hips(truth.joint_W_m[person]);
    log << fmt::format("  {} at {:.2f} {:.2f} {:.2f} tall {:.2f}", person, off.x(), off.y(),
                       off.z(), standing_height_m(skeleton));
  }

  // As two programs would do it, each told where its dancer stands.
  Result<void> run_separate() {
    IdentityJudge identities(couple_.hz());
    for (std::size_t person = 0; person < 2; ++person) {
      EstimatorOptions options = networks_;
      options.follow.choice = FollowOptions::Choice::kNearest;
      options.follow.place_px =
          couple_.truth(wishes_.first_frame).joint_px[person][kHipsAt].cast<float>();
      DANCE_TRY(auto estimator, PoseEstimator::open(options));
      for (std::size_t f = wishes_.first_frame; f < end_; ++f) {
        DANCE_TRY(const Frame frame, frame_of(f, DrawnCouple::Who::kBoth));
        estimator->estimate(frame);
        identities.judge(couple_.truth(f), references(f), person, estimator->unfiltered());
      }
    }
    score_.separate = identities.figures();
    return {};
  }

  Result<void> run_alone(std::size_t person) {
    DANCE_TRY(auto estimator, PoseEstimator::open(networks_));
    BodySolver solver(SolverOptions{}, couple_.pinhole());
    WristJudge wrists;
    std::vector<double> times;
    for (std::size_t f = wishes_.first_frame; f < end_; ++f) {
      DANCE_TRY(const Frame frame,
                frame_of(f, person == 0 ? DrawnCouple::Who::kLead : DrawnCouple::Who::kFollow));
      const double begin = thread_ms();
      estimator->estimate(frame);
      references_[f - wishes_.first_frame][person] = estimator->unfiltered().found
                                                         ? places_px(estimator->unfiltered())
                                                         : couple_.truth(f).joint_px[person];
      Pose pose;
      const bool is_shown = solver.solve(estimator->unfiltered(), std::nullopt, pose);
      times.push_back(thread_ms() - begin);
      if (is_shown && f >= wishes_.first_frame + kWarmUp)
        wrists.judge(couple_.truth(f), person, solver.skeleton(), pose);
    }
    add(score_.alone, wrists.figures());
    score_.alone_ms_median = std::max(score_.alone_ms_median, percentile_of(times, 0.5));
    return {};
  }

  DrawnCouple& couple_;
  CoupleWishes wishes_;
  std::size_t end_ = 0;
  EstimatorOptions networks_;
  std::vector<References> references_;  // of each frame
  bool is_numbered_ = false, is_exchanged_ = false;
  CoupleScore score_;
};

void add(IdentityFigures& sum, const IdentityFigures& more) {
  sum.frames += more.frames;
  sum.right += more.right;
  sum.wrong += more.wrong;
  sum.missing += more.missing;
  sum.longest_wrong_s = std::max(sum.longest_wrong_s, more.longest_wrong_s);
}

}  // namespace

Result<CoupleScore> evaluate_couple(DrawnCouple& couple, const CoupleWishes& wishes) {
  return Evaluation(couple, wishes).run();
}

CoupleScore all_of(const std::vector<CoupleScore>& scores) {
  CoupleScore all;
  all.name = fmt::format("all {}", scores.size());
  std::vector<double> ms, p95, alone;
  for (const CoupleScore& score : scores) {
    add(all.separate, score.separate);
    add(all.people, score.people);
    add(all.alone, score.alone);
    add(all.together, score.together);
    all.counters.pictures += score.counters.pictures;
    all.counters.searches += score.counters.searches;
    all.counters.reads += score.counters.reads;
    all.counters.duplicates += score.counters.duplicates;
    all.counters.exchanged += score.counters.exchanged;
    all.counters.reassigned += score.counters.reassigned;
    all.counters.limbs_hidden += score.counters.limbs_hidden;
    ms.push_back(score.ms_median);
    p95.push_back(score.ms_p95);
    alone.push_back(score.alone_ms_median);
  }
  all.ms_median = percentile_of(ms, 0.5);
  all.ms_p95 = percentile_of(p95, 0.5);
  all.alone_ms_median = percentile_of(alone, 0.5);
  return all;
}

}  // namespace dance
