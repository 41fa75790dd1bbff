// Which earlier frames an encoder may refer to, chosen from what the path to the receivers loses
// and how long an acknowledgement takes. The previous frame costs fewest bytes, but each loss is
// missed until the next intra frame; acknowledged frames are safe, but old where the path is long;
// the previous frame sent twice is between. Of what arrives 99.5 % shall decode at once: the
// cheapest that bears what is lost.
//
// Units/frames: loss is a share of datagrams, to the worst receiver.
// Ownership:    plain value.
// Threads:      none inside; time is an argument.
// Failure:      none. Thresholds have a gap, and a choice stands for a second, so that it does not
//               flutter; the previous frame alone is left at once.
#pragma once

#include <algorithm>

#include "core/base/time.h"
#include "core/codec/pose_codec.h"

namespace dance {

// What the server said last about the path to the receivers.
struct PathStats {
  bool is_known = false;
  double loss = 0.0;      // share, to the worst receiver
  double in_a_row = 0.0;  // the share that is lost together with the datagram before it
  Duration round_trip;
};

class ReferencePolicy {
 public:
  // `in_a_row`: the share that is lost together with the one before it.
  References update(double loss, double in_a_row, Duration round_trip, Duration frame,
                    MonoTime now) {
    const References wanted = choose(loss, in_a_row, round_trip, frame);
    const bool is_urgent = current_ == References::kPrevious && wanted != current_;
    if (wanted == current_ || (!is_urgent && chosen_at_.is_set() && now - chosen_at_ < kStands))
      return current_;
    current_ = wanted;
    chosen_at_ = now;
    return current_;
  }
  References current() const { return current_; }

  // Whether each frame may refer to the one before, so that nobody need tell soon what has come.
  static bool tolerates_loss(double loss, Duration round_trip, Duration frame) {
    return loss * frames_to_heal(round_trip, frame) < kEasilyBorne;
  }

  // What to refer to while receivers have told of nothing for so long. A path that is cut tells
  // nothing: what is sent now would refer to what it swallows, and the first pose after it would
  // decode nowhere. By frames that receivers have, it decodes at once. Where nothing was lost it
  // cost a few bytes. After kComesBackNew the server has forgotten who was cut off, who then asks
  // for an intra frame.
  References while_silent_for(Duration silence, Duration frame) const {
    const bool is_cut =
        silence > std::max(kTellsWithin, frame * kFramesTold) && silence < kComesBackNew;
    return is_cut ? References::kAcknowledged : current_;
  }

 private:
  static constexpr Duration kStands = Duration::s(1);
  static constexpr Duration kTellsWithin = Duration::ms(100);
  static constexpr std::int64_t kFramesTold = 4;
  static constexpr Duration kComesBackNew = Duration::s(2);

  static double frames_to_heal(Duration round_trip, Duration frame) {
    return round_trip.as_ms() / frame.as_ms() + 3.0;
  }

  References choose(double loss, double in_a_row, Duration round_trip, Duration frame) const {
    const bool is_bare = current_ == References::kPrevious;
    const bool is_twice = current_ == References::kPreviousTwice;
    // What is not borne keeps all from decoding until it is noticed and an intra frame is there.
    const double heals_frames = frames_to_heal(round_trip, frame);
    if (loss * heals_frames < (is_bare ? kBearable : kEasilyBorne)) return References::kPrevious;
    // Eight frames, and half a frame to either side: beyond, a frame and the one before it cost
    // less than one that refers so far back (dance codec eval --loss).
    const bool is_long = round_trip * 2 > frame * (is_twice ? 15 : 17);
    const bool bears = in_a_row * heals_frames < (is_twice ? kBearable : kEasilyBorne);
    return is_long && bears ? References::kPreviousTwice : References::kAcknowledged;
  }

  // The share of what arrives that may be undecodable: to stay with a choice, and to make it.
  static constexpr double kBearable = 0.005;
  static constexpr double kEasilyBorne = 0.0035;

  References current_ = References::kPreviousTwice;  // nothing is known yet
  MonoTime chosen_at_;
};

}  // namespace dance
