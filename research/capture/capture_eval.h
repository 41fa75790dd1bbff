// dance capture eval: what the camera's eye makes of pictures and videos, frame by frame, and what
// it costs.
//
// Units/frames: as producers/camera/body_landmarks.h says; milliseconds of this thread's processor
//               time.
// Ownership:    plain values.
// Threads:      none inside; reads files on the caller's thread.
// Failure:      an Error names the file and what is wrong with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/face/face_tracker.h"
#include "producers/camera/people/people_estimator.h"
#include "research/capture/hands_eval.h"

namespace dance {

struct CaptureEvalOptions {
  EstimatorOptions estimator;
  // Two and more: as capture sees several dancers (producers/camera/people), not smoothed.
  std::size_t people = 1;
  std::uint32_t every = 1;  // n-th frame of a video
  bool compares_engines = false;
  bool sees_hands = false;
  bool sees_face = false;
  bool judges_hands = false;  // what they do to a video's poses, too
  // Pictures are the frames of one video at this rate; 0: each for itself.
  double sequence_hz = 0.0;
  // This frame of each video is black: the body is lost, and found again in the next.
  std::optional<std::uint64_t> lost_frame;
};

struct CapturedPerson {
  BodyLandmarks body;
  BodyLandmarks unfiltered;
  std::array<HandLandmarks, 2> hands;  // left, right
  FaceLandmarks face;
};
struct EvaluatedFrame {
  std::string name;  // "messi.jpg", "dance.mp4#12"
  // As many as were asked for, each in one place throughout a video, found or not.
  std::vector<CapturedPerson> people;
};

// The same regions in both engines.
struct EngineComparison {
  std::size_t regions = 0;
  double first_ms = 0.0, second_ms = 0.0;  // together
  double worst_point_px = 0.0;             // of the network's 256
  double worst_world_m = 0.0;
  EngineKind first = EngineKind::kFastest, second = EngineKind::kOpenCv;
};

struct CaptureRun {
  std::vector<EvaluatedFrame> frames;
  double ms = 0.0;  // estimating, all frames together
  double decode_ms = 0.0;
  double hands_ms = 0.0;  // of both
  double face_ms = 0.0;
  HandFigures hands;
  EstimatorCounters counters;  // of one dancer
  EstimatorTimes times;
  PeopleCounters of_several;
  EngineComparison engines;
};

// Pictures are each for themselves; a video's frames follow each other in its own time.
Result<CaptureRun> evaluate_capture(const std::vector<std::string>& files,
                                    const CaptureEvalOptions& options);

// After a lost frame the smoother of metres goes on, as in the original. How far the metres of the
// frames after it are from those of a smoother that went on, of one that began anew, and of an
// uninterrupted run, whose regions are others: means over the points, then over the frames.
struct LossComparison {
  int frames = 0;
  double from_continued_mm = 0.0, from_begun_anew_mm = 0.0;
  double from_uninterrupted_mm = 0.0;
};
LossComparison compare_after_loss(const CaptureRun& lost, const CaptureRun& uninterrupted,
                                  std::size_t lost_frame);

std::string capture_eval_table(const CaptureRun& run, const CaptureEvalOptions& options);
// Of one dancer a frame bears the points itself, of several it has one object for each.
std::string capture_eval_json(const CaptureRun& run);

}  // namespace dance
