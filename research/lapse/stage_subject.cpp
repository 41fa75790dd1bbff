#include "research/lapse/stage_subject.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/motion/finish.h"
#include "core/motion/rotation_vector.h"
#include "core/pose/history.h"
#include "transformers/conceal/continuation.h"

namespace dance {
namespace {

class NewestSubject : public StageSubject {
 public:
  void observe(const Pose& pose, MonoTime) override {
    if (!is_known_ || pose.capture_time > newest_.capture_time) newest_ = pose;
    is_known_ = true;
  }
  bool sample(MonoTime, Pose& out) override {
    out = newest_;
    return is_known_;
  }

 private:
  Pose newest_;
  bool is_known_ = false;
};

class ContinuationSubject : public StageSubject {
 public:
  explicit ContinuationSubject(const Skeleton& skeleton) : skeleton_(skeleton), history_(2048) {
    finish_.set_body(skeleton);
  }
  void observe(const Pose& pose, MonoTime now) override {
    Pose was;
    const bool was_predicted = continuation_.is_running();
    if (was_predicted) continuation_.at(now - history_.newest().capture_time, was);
    continuation_.end();
    if (!history_.push(pose)) return;
    if (was_predicted) finish_.correct(now, was, pose);
  }
  bool sample(MonoTime now, Pose& out) override {
    if (history_.empty()) return false;
    const Duration since = now - history_.newest().capture_time;
    out = history_.newest();
    const bool is_predicted = since > Duration::ms(1);
    if (is_predicted) {
      if (!continuation_.is_running()) continuation_.begin(history_, skeleton_);
      continuation_.at(since, out);
    }
    finish_.apply(now, out, is_predicted);
    return true;
  }

 private:
  Skeleton skeleton_;
  PoseHistory history_;
  Continuation continuation_;
  Finish finish_;
};

class FlowSubject : public StageSubject {
 public:
  FlowSubject(const std::vector<std::string>& through, const FlowParts& parts,
              const Skeleton& skeleton) {
    auto flow = Flow::make(through, parts);
    DANCE_ASSERT(flow.has_value());
    flow_ = std::move(*flow);
    flow_.set_body(skeleton);
    learner_ = flow_.learner();
  }
  void observe(const Pose& pose, MonoTime now) override {
    flow_.observe(pose, now);
    // As the house's own thread does, a few times a second.
    if (learner_ && pose.sequence % 20 == 0) learner_->learn();
  }
  bool sample(MonoTime now, Pose& out) override { return flow_.sample(now, out); }

 private:
  Flow flow_;
  std::shared_ptr<Learner> learner_;
};

// v of each bone and of the hips: the slope of the least squares line through the last frames.
class DampedVelocitySubject : public StageSubject {
 public:
  explicit DampedVelocitySubject(Duration half_life)
      : history_(64), is_smooth_(half_life > Duration()) {
    if (is_smooth_) correction_.set_half_life(half_life);
  }
  void observe(const Pose& pose, MonoTime) override {
    Pose was, is;
    const bool corrects = is_smooth_ && shown_at_.is_set() && predict(shown_at_, was);
    if (!history_.push(pose)) return;
    if (corrects && predict(shown_at_, is)) correction_.add(shown_at_, was, is);
  }
  bool sample(MonoTime now, Pose& out) override {
    if (!predict(now, out)) return false;
    if (is_smooth_) correction_.apply(now, out);
    shown_at_ = now;
    return true;
  }

 private:
  static constexpr std::size_t kFrames = 6;
  static constexpr double kTau_s = 0.1;

  bool predict(MonoTime moment, Pose& out) const {
    if (history_.size() < kFrames) return false;
    const Pose& newest = history_.newest();
    double mean_s = 0.0, square = 0.0;
    const auto age_s = [&](std::size_t i) {
      return (history_.newest(i).capture_time - newest.capture_time).as_seconds();
    };
    for (std::size_t i = 0; i < kFrames; ++i) mean_s += age_s(i) / kFrames;
    for (std::size_t i = 0; i < kFrames; ++i) square += (age_s(i) - mean_s) * (age_s(i) - mean_s);
    const double ahead_s = std::max(0.0, (moment - newest.capture_time).as_seconds());
    const double reach_s = kTau_s * (1.0 - std::exp(-ahead_s / kTau_s));
    out = newest;
    out.capture_time = std::max(moment, newest.capture_time);
    for (std::size_t i = 1; i < kFrames; ++i) {
      const Pose& pose = history_.newest(i);
      // Differences to the newest: theirs is zero.
      const auto weight = static_cast<float>(reach_s * (age_s(i) - mean_s) / square);
      out.p_WH_m += weight * (pose.p_WH_m - newest.p_WH_m);
      for (std::size_t b = 0; b < kBoneCount; ++b)
        out.R_PB[b] =
            exp_rotation(weight * rotation_vector(pose.R_PB[b] * newest.R_PB[b].conjugate())) *
            out.R_PB[b];
    }
    normalize(out);
    return true;
  }

  PoseHistory history_;
  Inertializer correction_;
  bool is_smooth_;
  MonoTime shown_at_;
};

}  // namespace

MakeSubject newest_subject() {
  return [](const Skeleton&) { return std::make_unique<NewestSubject>(); };
}

MakeSubject continuation_subject() {
  return [](const Skeleton& skeleton) { return std::make_unique<ContinuationSubject>(skeleton); };
}

MakeSubject flow_subject(const std::vector<std::string>& through, const FlowParts& parts) {
  return [through, parts](const Skeleton& skeleton) {
    return std::make_unique<FlowSubject>(through, parts, skeleton);
  };
}

MakeSubject damped_velocity_subject(Duration half_life) {
  return
      [half_life](const Skeleton&) { return std::make_unique<DampedVelocitySubject>(half_life); };
}

Result<void> add_flow_subjects(const std::vector<std::string>& flows, NamedSubjects& subjects,
                               const FlowParts& parts) {
  for (const std::string& text : flows) {
    const std::vector<std::string> through = words_of(text);
    DANCE_TRY(const Flow flow, Flow::make(through, parts));
    if (!flow.is_pass_through()) subjects.emplace_back(text, flow_subject(through, parts));
  }
  return {};
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

}  // namespace dance
