// The journey of poses in numbers: from the stamps that each step leaves on a pose, how long the
// way from step to step took, per guest. `dance latency` prints it.
//
// Units/frames: stamps are of the clock that a pose's clock_id names. Stamps of one pose are
//               compared with each other; with our own clock only where that is the pose's.
// Ownership:    room for kMaxJourneyGuests; a guest's histograms are made when the guest is first
//               heard.
// Threads:      none inside; one owner.
// Failure:      guests beyond the bound are counted; stamps that run backwards are counted as
//               backwards and left out.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/histogram.h"
#include "core/bus/messages.h"
#include "core/pose/pose.h"

namespace dance {

// What leaves a stamp, in the order of the journey.
enum class Step : std::uint8_t {
  kCaptured,
  kPublished,
  kLinkSent,
  kServer,
  kLinkReceived,
  kStageTaken,
  kStaged,
  kHeard,  // taken from the bus by a display, or by us where no display runs
  kShown,
};
constexpr std::size_t kStepCount = 9;

// "link sent"; what a table says beside it.
std::string_view step_name(Step step);
std::string_view step_meaning(Step step);

class GuestJourney {
 public:
  explicit GuestJourney(const GuestId& guest) : guest_(guest) {}

  // From POSE/stage/<guest>, heard here.
  void heard(const Pose& pose, MonoTime now, std::uint64_t our_clock_id);
  // From STAGE_TIME/view/<guest>.
  void shown(const StageTime& stage_time);

  struct Row {
    Step from;
    Step to;
    const Histogram* took;
    const Histogram* since_capture;  // null where the capture's time is not known
  };
  // Step by step in the order of the journey. The last steps are a display's where one runs, else
  // they end with this program; a step without poses has no row.
  std::vector<Row> rows() const;
  bool has_passed(Step step) const;

  const GuestId& guest() const { return guest_; }
  std::uint64_t poses() const { return poses_; }
  std::uint64_t frames() const { return frames_; }
  // Poses and frames whose stamps could not be compared with our clock, or with each other.
  std::uint64_t without_clock() const { return without_clock_; }
  std::uint64_t of_another_clock() const { return of_another_clock_; }
  std::uint64_t backwards() const { return backwards_; }

 private:
  using Stamps = std::array<MonoTime, kStepCount>;
  struct Way {
    // took[from][to] and since_capture[to], made when first needed.
    std::array<std::array<std::unique_ptr<Histogram>, kStepCount>, kStepCount> took;
    std::array<std::unique_ptr<Histogram>, kStepCount> since_capture;
  };

  void add(Way& way, const Stamps& stamps);
  void add_one(std::unique_ptr<Histogram>& histogram, Duration took);
  const Way& way_to(std::size_t step) const;

  GuestId guest_;
  Way heard_;  // from poses on the stage
  Way shown_;  // from displays
  std::uint64_t poses_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t without_clock_ = 0;
  std::uint64_t of_another_clock_ = 0;
  std::uint64_t backwards_ = 0;
};

class Journeys {
 public:
  static constexpr std::size_t kMaxJourneyGuests = 64;

  // nullptr beyond the bound.
  GuestJourney* of(const GuestId& guest);
  const std::vector<std::unique_ptr<GuestJourney>>& all() const { return all_; }
  std::uint64_t refused() const { return refused_; }

 private:
  std::vector<std::unique_ptr<GuestJourney>> all_;
  std::uint64_t refused_ = 0;
};

}  // namespace dance
