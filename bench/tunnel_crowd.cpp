#include <string>
#include <vector>

#include "bench/crowd.h"
#include "core/base/assert.h"
#include "core/net/mono_clock.h"
#include "tunnel/link.h"
#include "tunnel/seal/key_files.h"

namespace dance {
namespace {

GuestId guest_name(std::size_t number) { return *GuestId::parse("g" + std::to_string(number)); }

// Hears without looking: for guests who only make the crowd. What the others of a real crowd decode,
// they decode on machines of their own.
class DeafDecoder final : public PoseDecoder {
 public:
  explicit DeafDecoder(CodecName name) : name_(name) {}
  CodecName name() const override { return name_; }
  DecodeResult decode(std::uint32_t, std::span<const std::uint8_t>, Pose&) override {
    return DecodeResult::kPose;
  }
  void restart() override {}
  void set_skeleton(const Skeleton&) override {}

 private:
  CodecName name_;
};

class TunnelCrowd final : public Crowd {
 public:
  Result<void> open(const CrowdOptions& options, Poller& poller) {
    LinkKey key;
    key.name = kLocalKeyName;
    DANCE_TRY(key.key, local_key());
    for (std::size_t i = 0; i < options.guests; ++i) {
      LinkOptions of;
      of.room = guest_name(0);
      const bool fits = of.guests.try_push(guest_name(i));
      DANCE_ASSERT(fits);
      if (i >= kListeners)
        of.make_decoder = [](CodecName name) { return std::make_unique<DeafDecoder>(name); };
      LinkHandlers handlers;
      handlers.on_pose = [heard = options.heard, i](const GuestId& who, const Pose& pose,
                                                    MonoTime) {
        std::size_t sender = 0;
        for (const char c : who.view().substr(1))
          sender = 10 * sender + static_cast<std::size_t>(c - '0');
        heard(i, sender, pose.sequence);
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
  std::uint64_t bytes_down() const override {
    std::uint64_t sum = 0;
    for (const auto& link : links_)
      sum += link->counters().bytes_in + kIpUdp_bytes * link->counters().datagrams_in;
    return sum;
  }

 private:
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
