#include "headset/capture/headset_capture.h"

#include <fmt/format.h>
#include <pthread.h>

#include "core/program/talk.h"
#include "headset/haptics/xr_haptics.h"

namespace dance {
namespace {

// So long the others of the stage are waited for, before a free spot is chosen.
constexpr Duration kLooksRound = Duration::ms(800);
constexpr Duration kSpotEvery = Duration::ms(150);
constexpr Duration kIsLost = Duration::ms(1500);
constexpr Duration kPutDown = Duration::ms(1500);
constexpr float kBreathes_m = 0.004f;  // nobody holds the head stiller for so long
constexpr float kEyes = 0.936f;        // of a body's height; Winter (2009)

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
      spot_(memory.spot) {
  if (memory.body) dancer_.body().restore(*memory.body);
}

Result<void> HeadsetCapture::open() {
  DANCE_TRY(poller_, Poller::create());
  DANCE_TRY(bus_, Bus::open(options_.bus_url));
  port_ = std::make_unique<HousePublisher>(*bus_, bus_->url(), *poller_);
  sink_ = std::make_unique<PortCaptureSink>(*port_);
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
  memory.spot = spot_;
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
    if (!is_worn(moment))
      ++unworn_;
    else if (dancer_.solve(sight_, pose_))
      publish(moment);
    else
      ++without_head_;
    note_losses(moment);
  }
  tell();
  // An even beat, which skips what is missed.
  const Duration period = Duration::period_of_hz(options_.rate_hz);
  next_ = next_.is_set() ? next_ + period : now + period;
  if (next_ < moment) next_ = moment + period;
  return next_;
}

// A runtime's space that is moved leaves the dancer where the head was on the stage: exactly, where
// the runtime tells by how much.
void HeadsetCapture::follow_moves(MonoTime moment) {
  if (!move_) move_ = session_.take_move();
  if (!move_) {
    now_.recentres = session_.recentres();
    return;
  }
  if (now_.is_placed && moment < session_.runtime().mono_of(move_->at)) return;
  XrSpaceLocation location{};
  location.locationFlags =
      XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  location.pose = move_->new_in_old;
  const auto new_in_old = move_->is_known ? place_of(location, false) : std::nullopt;
  move_.reset();
  ++now_.jumps;
  if (new_in_old)
    now_.placement = moved(now_.placement, *new_in_old);
  else
    now_.is_placed = false;  // anew, below the head's last place
}

// Another space in a new session leaves the dancer where the head was. The first time, and when
// it is asked for, it is the spot that was chosen.
void HeadsetCapture::place(XrTime time, MonoTime moment) {
  follow_moves(moment);
  const bool is_asked = recentre_asked_.load(std::memory_order_acquire);
  const auto head = input_.head(time);
  if (!head) return;
  if (now_.is_placed && !is_asked) return keep_spot(now_.placement.in_house(*head), moment);
  // A headset that lies on a table looks nowhere.
  if (!session_.is_focused() || !spot_of(*head)) return;
  const bool is_chosen = is_asked || !spot_;
  if (is_chosen && !now_.is_placed && moment - begun_ < kLooksRound) return;
  recentre_asked_.store(false, std::memory_order_release);
  // Of a space without a floor: as far below the eyes as they are above it when one stands.
  const float floor =
      session_.has_stage() ? 0.0f : head->p_m.y() - kEyes * dancer_.values().height_m;
  const XrSpot spot = is_chosen ? others_.before(options_.spot, moment) : *spot_;
  now_.placement = placement_of(*head, spot, floor);
  now_.is_placed = true;
  ++now_.jumps;
}

// Some moments old, as a runtime may tell late that its space was moved.
void HeadsetCapture::keep_spot(const XrPlace& head, MonoTime moment) {
  if (next_spot_ && moment - spot_kept_ < kSpotEvery) return;
  const auto spot = spot_of(head);
  if (!spot) return;
  spot_ = next_spot_ ? next_spot_ : spot;
  next_spot_ = spot;
  spot_kept_ = moment;
}

// With its own menu open a headset moves on a head; one that was put down lies still.
bool HeadsetCapture::is_worn(MonoTime moment) {
  const bool has_head = sight_.points.has(TrackedPoint::kHead);
  const Eigen::Vector3f head = sight_.points.position(TrackedPoint::kHead);
  if (has_head && (head - rested_at_m_).norm() > kBreathes_m) rested_at_m_ = head, moved_ = moment;
  return session_.is_focused() || moment - moved_ < kPutDown;
}

void HeadsetCapture::publish(MonoTime captured) {
  received_->set_skeleton(dancer_.skeleton());
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

// Another thread says it: nothing is written here.
void HeadsetCapture::note_losses(MonoTime now) {
  // While the headset is put down all rests, which is a line of its own.
  const bool rests = !session_.is_focused();
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    const std::uint32_t bit = 1u << i;
    if (rests && seen_[i].is_set() && (now_.lost & bit) == 0) seen_[i] = now;
    if ((sight_.points.presence & bit) != 0) seen_[i] = now, now_.lost &= ~bit;
    if (seen_[i].is_set() && now - seen_[i] > kIsLost) now_.lost |= bit;
  }
}

std::string HeadsetCapture::summary() const {
  return fmt::format(
      "{} poses, {} moments without a head, {} while nobody wore it, {} places that could not be "
      "true; from the moment of the sensors to the bus {} us at the median, {} us at p99",
      poses_, without_head_, unworn_, input_.bad_places(), delay_.percentile(0.5).count_us(),
      delay_.percentile(0.99).count_us());
}

}  // namespace dance
