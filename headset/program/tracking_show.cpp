#include "headset/program/headset_run.h"
#include "headset/program/loss_words.h"

namespace dance {
namespace {

class TrackingShow final : public HeadsetShow {
 public:
  explicit TrackingShow(std::unique_ptr<Poller> poller) : poller_(std::move(poller)) {}
  XrUse use() const override { return XrUse::kTracking; }
  Result<const void*> binding(const XrRuntime&) override { return nullptr; }
  Result<void> begin(XrDancerSession&, XrInput&, HeadsetCapture& capture) override {
    capture_ = &capture;
    losses_ = {};
    return {};
  }
  // Nothing is drawn: the capture has its own thread.
  Result<void> turn() override {
    if (const HeadsetTold* told = capture_->told()) losses_.tell(told->lost);
    wait(Duration::ms(20));
    return {};
  }
  void end() override { capture_ = nullptr; }
  void wait(Duration longest) override { poller_->run_once(longest); }
  bool is_over() const override { return poller_->is_stopped(); }
  bool has_left() const override { return false; }

 private:
  std::unique_ptr<Poller> poller_;
  HeadsetCapture* capture_ = nullptr;
  LossWords losses_;
};

}  // namespace

Result<std::unique_ptr<HeadsetShow>> make_tracking_show() {
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return tl::make_unexpected(stops.error());
  return std::make_unique<TrackingShow>(std::move(poller));
}

}  // namespace dance
