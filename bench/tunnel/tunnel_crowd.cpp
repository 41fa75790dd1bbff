#include <string>
#include <vector>

#include "bench/tunnel/crowd.h"
#include "core/base/assert.h"
#include "core/net/mono_clock.h"
#include "testing/undecoded_poses.h"
#include "tunnel/link/link.h"
#include "tunnel/seal/keys/key_files.h"

namespace dance {
namespace {

GuestId guest_name(std::size_t number) { return *GuestId::parse("g" + std::to_string(number)); }

// Counts what comes.
class CountingDecoder final : public PoseDecoder {
 public:
  CountingDecoder(CodecName name, bool is_deaf, Traffic& traffic)
      : real_(is_deaf ? std::make_unique<UndecodedPoses>(name) : make_pose_decoder(name)),
        traffic_(traffic) {}
  CodecName name() const override { return real_->name(); }
  DecodeResult decode(std::uint32_t sequence, std::span<const std::uint8_t> payload,
                      Pose& pose) override {
    const DecodeResult result = real_->decode(sequence, payload, pose);
    if (result != DecodeResult::kPose) return result;
    ++traffic_.poses_down;
    traffic_.payload_down += payload.size();
    return result;
  }
  void restart() override { real_->restart(); }
  void set_skeleton(const Skeleton& skeleton) override { real_->set_skeleton(skeleton); }

 private:
  std::unique_ptr<PoseDecoder> real_;
  Traffic& traffic_;
};

class TunnelCrowd final : public Crowd {
 public:
  Result<void> open(const CrowdOptions& options, Poller& poller) {
    LinkKey key;
    key.identity = kLocalKeyName;
    DANCE_TRY(key.key, local_key());
    for (std::size_t i = 0; i < options.guests; ++i) {
      LinkOptions of;
      of.room = guest_name(0);
      const bool fits = of.guests.try_push(guest_name(i));
      DANCE_ASSERT(fits);
      if (options.codec) (void)of.codecs.try_push(*options.codec);
      of.make_decoder = [this, is_deaf = i >= kListeners](CodecName name) {
        return std::make_unique<CountingDecoder>(name, is_deaf, decoded_);
      };
      LinkHandlers handlers;
      handlers.on_pose = [heard = options.heard, i](const GuestId& who, const Pose& pose,
                                                    MonoTime) {
        std::size_t sender = 0;
        for (const char c : who.view().substr(1))
          sender = 10 * sender + static_cast<std::size_t>(c - '0');
        heard(i, sender, pose.sequence);
      };
      handlers.on_voice = [heard = options.heard_voice, i](const GuestId&, const Voice& voice,
                                                           MonoTime) {
        if (heard) heard(i, voice);
      };
      DANCE_TRY(std::unique_ptr<Link> link,
                Link::open({options.relay}, key, of, std::move(handlers), poller));
      links_.push_back(std::move(link));
    }
    return {};
  }
  bool is_open() override {
    for (const auto& link : links_)
      if (!link->is_connected() || link->remote_stats().size() + 1 != links_.size()) return false;
    return true;
  }
  void send(std::size_t guest, const Pose& pose, MonoTime now) override {
    links_[guest]->send(guest_name(guest), pose, now);
  }
  void speak(std::size_t guest, const Voice& voice, MonoTime now) override {
    links_[guest]->send(guest_name(guest), voice, now);
  }
  Traffic traffic() const override {
    Traffic sum = decoded_;
    for (const auto& link : links_) {
      const LinkCounters& counters = link->counters();
      sum.bytes_up += counters.bytes_out + kIpUdp_bytes * counters.datagrams_out;
      sum.bytes_down += counters.bytes_in + kIpUdp_bytes * counters.datagrams_in;
      sum.voice_bytes_up += counters.voice_bytes_out + kIpUdp_bytes * counters.voice_datagrams_out;
      sum.voice_bytes_down += counters.voice_bytes_in + kIpUdp_bytes * counters.voice_datagrams_in;
      sum.voices_down += counters.voices_delivered;
    }
    return sum;
  }

 private:
  Traffic decoded_;
  std::vector<std::unique_ptr<Link>> links_;
};

}  // namespace

Result<std::unique_ptr<Crowd>> open_tunnel_crowd(const CrowdOptions& options, Poller& poller) {
  auto crowd = std::make_unique<TunnelCrowd>();
  if (auto opened = crowd->open(options, poller); !opened)
    return tl::make_unexpected(opened.error());
  return crowd;
}

}  // namespace dance
