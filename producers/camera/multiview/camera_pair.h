// CameraPair: where a second camera stands beside the first and how much later its stamps are,
// found from the dancer's motion alone and followed: no board, no wire. The dancer's height gives
// the scale.
//
// Units/frames: relative_pose.h; metres; each camera's own stamps.
// Ownership:    keeps half a minute of both cameras (about 700 KB); never allocates after
//               construction.
// Threads:      none inside; one owner.
// Failure:      no placement until both cameras have seen the dancer move for some seconds; one
//               whose rays no longer meet is given up, counted, and searched again. Work in one
//               call is bounded (about 0.5 ms).
#pragma once

#include <cstdint>
#include <optional>

#include "producers/camera/multiview/epipolar_fit.h"
#include "producers/camera/multiview/joint_lengths.h"
#include "producers/camera/multiview/key_moments.h"
#include "producers/camera/multiview/relative_pose.h"
#include "producers/camera/multiview/view_history.h"

namespace dance {

struct DancerSize {
  std::optional<double> told_m;  // the standing height, where it is given
  // Else: as height_of() has the body that the first camera measured.
  double measured_m = 0.0;
};

struct PairPlacement {
  RelativePose pose;
  double baseline_m = 0.0;
  double angle_rad = 0.0;  // at which the rays of both cameras meet at the dancer
  double turn_sd_rad = 0.0;
  double later_sd_s = 0.0;
  double spread = 0.0;  // how far rays miss each other, in standard deviations of one

  // Where the second camera is, in the first one's frame.
  Eigen::Vector3d p_AB_m() const { return -baseline_m * (pose.R_BA.transpose() * pose.p_BA); }
};

class CameraPair {
 public:
  // Of the second camera.
  void see_other(const ViewPoints& points);
  // Of the first one, at the rate of its pictures: does a part of the work.
  void see_first(const ViewPoints& points, const DancerSize& size);

  bool is_settled() const { return placement_.has_value(); }
  const std::optional<PairPlacement>& placement() const { return placement_; }
  // How often a placement was given up, as a camera was moved.
  int moves() const { return moves_; }
  // The dancer's lengths by both cameras, once after each placement.
  std::optional<BodyLengths> take_lengths();
  // Another dancer, with other lengths.
  void reset_body();
  // Moments with a moving dancer that both cameras saw, of kFewestMoments that a search needs.
  static constexpr int kFewestMoments = 40;
  int moments() const { return static_cast<int>(moments_.count()); }

 private:
  struct Candidate {
    RelativePose pose;
    double cost = 1e9;
  };
  static constexpr int kStarts = 7;

  void search();
  void begin_start();
  void accept_or_wait();
  void follow(const DancerSize& size);
  void check_moments();
  void give_up();
  bool is_good() const;
  void finish_lengths(const DancerSize& size);

  ViewHistory other_;
  KeyMoments moments_;
  EpipolarFit fit_;
  JointLengths lengths_;
  // The search: from which start, and how many iterations of it are done.
  bool is_searching_ = false;
  int start_ = 0, iteration_ = 0;
  bool has_start_ = false;
  Candidate best_;
  std::uint64_t search_from_ = kFewestMoments;
  // The lengths of the pose that was found, before it counts.
  bool is_measuring_ = false;
  std::uint32_t calls_ = 0;
  std::uint64_t checked_ = 0;  // moments whose spread was looked at
  double recent_spread_ = 0.0, usual_spread_ = 0.0;
  int moves_ = 0;
  MonoTime now_;
  std::optional<PairPlacement> placement_;
  std::optional<BodyLengths> new_lengths_;
  bool has_told_lengths_ = false;
};

}  // namespace dance
