#include "producers/camera/program/landmark_source.h"

#include <algorithm>
#include <utility>

namespace dance {
namespace {

class OneDancer final : public LandmarkSource {
 public:
  explicit OneDancer(std::unique_ptr<PoseEstimator> estimator) : estimator_(std::move(estimator)) {}
  std::span<const BodyLandmarks> see(const Frame& frame) override {
    estimator_->estimate(frame);
    return {&estimator_->unfiltered(), 1};
  }
  void restart() override { estimator_->reset(); }
  std::uint64_t searches() const override { return estimator_->counters().searches; }

 private:
  std::unique_ptr<PoseEstimator> estimator_;
};

class SeveralDancers final : public LandmarkSource {
 public:
  explicit SeveralDancers(std::unique_ptr<PeopleEstimator> estimator)
      : estimator_(std::move(estimator)) {}
  std::span<const BodyLandmarks> see(const Frame& frame) override {
    for (std::size_t i = 0; i < reads_.size(); ++i) reads_[i] = (picture_ + i) % turns_ == 0;
    ++picture_;
    return estimator_->estimate(frame, reads_);
  }
  bool is_left_out(std::size_t dancer) const override { return !reads_[dancer]; }
  void restart() override { estimator_->lose_all(); }
  std::uint64_t searches() const override { return estimator_->tracker().counters().searches; }
  void set_turns(std::size_t turns) override {
    turns_ = std::clamp<std::size_t>(turns, 1, estimator_->tracker().people());
  }

 private:
  std::unique_ptr<PeopleEstimator> estimator_;
  std::size_t picture_ = 0, turns_ = 1;
  PeopleTracker::Reads reads_{};
};

}  // namespace

Result<std::unique_ptr<LandmarkSource>> open_landmark_source(const EstimatorOptions& options,
                                                             std::size_t dancers) {
  if (dancers > 1) {
    PeopleOptions people;
    people.people = dancers;
    DANCE_TRY(auto estimator, PeopleEstimator::open(options, people));
    return std::make_unique<SeveralDancers>(std::move(estimator));
  }
  DANCE_TRY(auto estimator, PoseEstimator::open(options));
  return std::make_unique<OneDancer>(std::move(estimator));
}

}  // namespace dance
