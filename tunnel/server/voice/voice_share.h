// What of a receiver's line is left for voices when the poses have theirs. A line without a limit
// bears all. On a narrow one whole voices go or none: half of a voice's packets are no speech. They
// come back one by one, and more slowly each time that was too early.
//
// Units/frames: bytes a second with all headers; MonoTime of the server's clock.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; poses get their bytes whatever voices want.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/time.h"
#include "core/net/datagram_sink.h"
#include "tunnel/server/pace/pose_flow.h"
#include "tunnel/server/voice/talker_places.h"
#include "tunnel/wire/wire_voice.h"

namespace dance {

class VoiceShare {
 public:
  // What one packet costs in a datagram of its own.
  static constexpr std::size_t cost_of(std::size_t packet_bytes) {
    return kIpUdp_bytes + wire::kSealOverhead + wire::kVoiceOpening + wire::kVoiceRecordHeader +
           packet_bytes;
  }

  // How many voices may go: those in the first of TalkerPlaces' places.
  std::size_t voices() const { return voices_; }
  // Voices that were for this receiver, sent or not.
  void note_wanted(std::size_t packet_bytes) { wanted_.add(cost_of(packet_bytes)); }
  void sample(double seconds) { wanted_.sample(seconds); }
  // What they take when all go.
  double wanted_bytes_per_s() const { return wanted_.bytes_per_s(); }

  // The line bears `left` bytes a second beside the poses; `is_limited`: or it bears all.
  void settle(bool is_limited, double left, MonoTime now) {
    is_limited_ = is_limited;
    left_bytes_per_s_ = std::max(left, 0.0);
    if (!is_limited) {
      if (now >= not_before_) waits_ = kFirstWait;
      voices_ = kMaxTalkers;
      return;
    }
    const double each = bytes_per_s_each();
    const auto fit = static_cast<std::size_t>(std::clamp(left_bytes_per_s_ / each, 0.0, kMost));
    if (fit < voices_) {
      // Soon after one more: that was one too many.
      if (raised_.is_set() && now - raised_ < kTooEarly)
        waits_ = std::min(waits_ * 2, kLongestWaitToRaise);
      voices_ = fit;
      not_before_ = now + waits_;
    } else if (fit > voices_ && now >= not_before_) {
      ++voices_;
      raised_ = now;
      not_before_ = now + waits_;
    }
  }
  // Whether so many bytes may go now. A burst of packets, as after a hiccup, goes no faster than
  // the line takes it.
  bool take(std::size_t bytes, MonoTime now) {
    if (!is_limited_) return true;
    const double passed_s =
        filled_at_.is_set() ? std::max(0.0, (now - filled_at_).as_seconds()) : kBurst.as_seconds();
    filled_at_ = now;
    const double burst = std::max(kLeastBurst_bytes, left_bytes_per_s_ * kBurst.as_seconds());
    tokens_ = std::min(burst, tokens_ + left_bytes_per_s_ * passed_s);
    if (tokens_ < static_cast<double>(bytes)) return false;
    tokens_ -= static_cast<double>(bytes);
    return true;
  }

 private:
  static constexpr Duration kBurst = Duration::ms(30);
  static constexpr double kLeastBurst_bytes = 500.0;
  static constexpr Duration kFirstWait = Duration::s(2), kLongestWaitToRaise = Duration::s(30);
  static constexpr Duration kTooEarly = Duration::s(5);
  static constexpr double kMost = kMaxTalkers;

  double bytes_per_s_each() const {
    constexpr double kUsualPacket_bytes = 40.0;
    const double packets = wanted_.poses_per_s();
    const double packet = packets > 1.0 ? wanted_.bytes_per_s() / packets
                                        : static_cast<double>(cost_of(0)) + kUsualPacket_bytes;
    return packet * Duration::s(1).as_seconds() / kVoiceFrame.as_seconds();
  }

  bool is_limited_ = false;
  double left_bytes_per_s_ = 0.0;
  double tokens_ = 0.0;
  MonoTime filled_at_;
  std::size_t voices_ = kMaxTalkers;
  PoseFlow wanted_;
  Duration waits_ = kFirstWait;
  MonoTime not_before_, raised_;
};

}  // namespace dance
