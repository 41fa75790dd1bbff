#include "headset/capture/headset_capture.h"

#include <fmt/format.h>
#include <pthread.h>

#include "core/program/talk.h"
#include "headset/haptics/xr_haptics.h"

namespace dance {
namespace {

// So long the others of the stage are waited for, before a free spot is chosen.
constexpr Duration kLooksRound = Duration::ms(800);
constexpr Duration kIsLost = Duration::ms(1500);
constexpr float kEyes = 0.936f;  // of a body's height; Winter (2009)

}  // namespace

Result<std::unique_ptr<HeadsetCapture>> HeadsetCapture::start(const XrDancerSession& session,
                                                              XrInput& input,
                                                              const HeadsetCaptureOptions& options,
                                                              const HeadsetMemory& memory) {
  std::unique_ptr<HeadsetCapture> capture(new HeadsetCapture(session, input, options, memory));
  if (auto opened = capture->open(); !opened) return tl::make_unexpected(opened.error());
  capture->thread_ = std::thread([raw = capture.get()] { raw->run(); });
  pthread_setname_np(capture->thread_.native_handle(), "headset-capture");
  return capture;
}

HeadsetCapture::HeadsetCapture(const XrDancerSession& session, XrInput& input,
                               const HeadsetCaptureOptions& options, const HeadsetMemory& memory)
    : session_(session),
      input_(input),
      options_(options),
      sensors_(session, input),
      dancer_(options.body),
      recentres_(session.recentres()) {
  if (memory.placement) now_.placement = *memory.placement, now_.is_placed = true;
  if (memory.body) dancer_.body().restore(*memory.body);
}

Result<void> HeadsetCapture::open() {
  DANCE_TRY(poller_, Poller::create());
  DANCE_TRY(bus_, Bus::open(options_.bus_url));
  sink_ = std::make_unique<PortCaptureSink>(*bus_);
  received_ = std::make_unique<ReceivedDancer>(options_.guest, *sink_);
  bus_->subscribe<Pose>(Where::kStage,
                        [this](const Channel& channel, const Pose& pose, MonoTime now) {
                          if (channel.guest() != options_.guest)
                            others_.hear(channel.guest(), pose, now);
                        });
  if (options_.haptics) {
    felt_ = std::make_unique<HapticFeed>(options_.guest, options_.felt, *bus_, *poller_);
    felt_->add(std::make_unique<HapticPlayer>(std::make_unique<XrHaptics>(session_, input_),
                                              options_.player, *poller_));
  }
  if (!sensors_.note().empty()) talk::warn("{}; without that", sensors_.note());
  return {};
}

HeadsetCapture::~HeadsetCapture() { stop(); }

HeadsetMemory HeadsetCapture::stop() {
  if (thread_.joinable()) {
    ends_.store(true, std::memory_order_release);
    thread_.join();
  }
  HeadsetMemory memory;
  if (now_.is_placed) memory.placement = now_.placement;
  if (dancer_.values().state != CalibrationState::kNeedsTPose) memory.body = dancer_.values();
  return memory;
}

void HeadsetCapture::run() {
  begun_ = mono_now();
  poller_->watch(bus_->fd(), [this](MonoTime now) { bus_->drain(now); });
  poller_->add_timer(begun_, [this](MonoTime now) { return tick(now); });
  poller_->run();
  poller_->unwatch(bus_->fd());
}

MonoTime HeadsetCapture::tick(MonoTime now) {
  if (ends_.load(std::memory_order_acquire)) {
    poller_->stop();
    return {};
  }
  if (t_pose_asked_.exchange(false, std::memory_order_acq_rel)) dancer_.body().request_t_pose();
  input_.sync();
  // After the devices are up to date, so that nothing lies between their moment and ours.
  const MonoTime moment = mono_now();
  const XrTime time = session_.is_running() ? session_.runtime().xr_of(moment) : 0;
  place(time, moment);
  if (now_.is_placed && time > 0) {
    sensors_.look(time, moment, now_.placement, sight_);
    if (dancer_.solve(sight_, pose_))
      publish(moment);
    else
      ++without_head_;
    tell_losses(moment);
  }
  tell();
  // An even beat, which skips what is missed.
  const Duration period = Duration::period_of_hz(options_.rate_hz);
  next_ = next_.is_set() ? next_ + period : now + period;
  if (next_ < moment) next_ = moment + period;
  return next_;
}

void HeadsetCapture::place(XrTime time, MonoTime moment) {
  const bool is_asked = recentre_asked_.load(std::memory_order_acquire);
  const bool is_moved = session_.recentres() != recentres_;
  if (now_.is_placed && !is_asked && !is_moved) return;
  if (!now_.is_placed && moment - begun_ < kLooksRound) return;
  const auto head = input_.head(time);
  if (!head) return;
  recentre_asked_.store(false, std::memory_order_release);
  recentres_ = session_.recentres();
  // Of a space without a floor: as far below the eyes as they are above it when one stands.
  const float floor =
      session_.has_stage() ? 0.0f : head->p_m.y() - kEyes * dancer_.values().height_m;
  now_.placement = placement_of(*head, others_.before(options_.spot, moment), floor);
  now_.is_placed = true;
  ++now_.jumps;
}

void HeadsetCapture::publish(MonoTime captured) {
  received_->set_skeleton(dancer_.skeleton());
  pose_.presence = kAllBones;
  pose_.confidence = 1.0f;
  // A body that was seen before is of then, and is published once.
  if (!received_->capture(pose_, pose_.capture_time, captured)) return;
  delay_.add(mono_now() - captured);
  ++poses_;
  if (sight_.hands.presence != 0) received_->capture(sight_.hands);
}

void HeadsetCapture::tell() {
  now_.body = dancer_.values();
  now_.t_pose_progress = dancer_.body().calibration().t_pose_progress();
  now_.awaits_t_pose = dancer_.body().calibration().awaits_t_pose();
  now_.tracked = sight_.points.presence;
  now_.sees_body = sight_.has_figure;
  for (const XrHand hand : {XrHand::kLeft, XrHand::kRight}) {
    const auto i = static_cast<std::size_t>(hand);
    now_.is_pressed[i] = input_.is_pressed(hand);
    now_.is_menu_pressed[i] = input_.is_menu_pressed(hand);
  }
  told_.put(now_);
}

// Nothing is written while nothing changes: never more than a line for each point and change. A
// headset that is put down, or shows its own menu, tells of no hands and trackers: that is a line
// of its own, and they are not lost.
void HeadsetCapture::tell_losses(MonoTime now) {
  const bool is_told_all = session_.is_focused();
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    const std::uint32_t bit = 1u << i;
    const bool is_seen = (sight_.points.presence & bit) != 0;
    if (is_seen || (!is_told_all && seen_[i].is_set())) seen_[i] = now;
    if (is_seen && (missed_ & bit) != 0) {
      missed_ &= ~bit;
      talk::info("{} is tracked again", kTrackedPointNames[i]);
    }
    if (!is_seen && seen_[i].is_set() && (missed_ & bit) == 0 && now - seen_[i] > kIsLost) {
      missed_ |= bit;
      talk::warn("{} is not tracked any more; the dance goes on without it", kTrackedPointNames[i]);
    }
  }
}

std::string HeadsetCapture::summary() const {
  return fmt::format(
      "{} poses, {} moments without a head; from the moment of the sensors to the bus {} us at the "
      "median, {} us at p99",
      poses_, without_head_, delay_.percentile(0.5).count_us(), delay_.percentile(0.99).count_us());
}

}  // namespace dance
