#include "producers/camera/program/capture_check.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <opencv2/imgproc.hpp>

#include "core/base/printable.h"
#include "core/net/mono_clock.h"
#include "core/program/talk.h"
#include "formats/camera_view/body_in_frame.h"
#include "producers/camera/check/camera_cause.h"
#include "producers/camera/check/picture_light.h"
#include "producers/camera/seen_body.h"
#include "viewer/words/texts.h"

namespace dance {
namespace {

constexpr Duration kTurn = Duration::ms(50);
constexpr Duration kViewEvery = Duration::ms(100);
constexpr Duration kTryEvery = Duration::s(1);
constexpr Duration kCountEvery = Duration::s(1);
constexpr Duration kNoPictures = Duration::s(3);
constexpr int kSmallWidth_px = 320;
constexpr int kSmallHeight_px = 180;

// Cut to what a record holds, on one line.
template <std::size_t kCapacity>
void assign(FixedString<kCapacity>& to, const std::string& text) {
  const std::string line = printable(text).substr(0, kCapacity);
  if (!to.assign(line)) to = {};
}

}  // namespace

Result<std::unique_ptr<CaptureCheck>> CaptureCheck::open(const CaptureOptions& options) {
  std::unique_ptr<CaptureCheck> check(new CaptureCheck(options));
  if (!options.wants_text) {
    if (::isatty(STDOUT_FILENO) == 1)
      return fail("--check writes bytes for a program; add --text to read it yourself");
    std::signal(SIGPIPE, SIG_IGN);  // NOLINT(cert-err33-c): cannot fail for this signal
    check->out_ = std::make_unique<NewestRecord>(STDOUT_FILENO);
  }
  DANCE_TRY(check->poller_, Poller::create());
  if (auto stops = check->poller_->stop_on_signals(); !stops)
    return tl::make_unexpected(stops.error());
  return check;
}

void CaptureCheck::open_estimator() {
  auto opened = PoseEstimator::open(networks_of(options_));
  if (opened)
    estimator_ = std::move(*opened);
  else
    network_trouble_ = opened.error().what;
  status_.has_network = estimator_ != nullptr;
}

void CaptureCheck::set_state(CameraState state, CameraCause cause, const std::string& words) {
  status_.state = state;
  status_.cause = cause;
  assign(status_.words, words);
  if (input_) {
    assign(status_.name, input_->name());
    status_.width_px = std::min(input_->format().width_px, 0xffff);
    status_.height_px = std::min(input_->format().height_px, 0xffff);
  }
  trouble_ = words;
  advice_.note(status_);
  if (out_) out_->put(status_);
  print_news();
}

void CaptureCheck::try_camera(MonoTime now) {
  if (now < next_try_) return;
  auto opened = CaptureInput::open(options_);
  next_try_ = mono_now() + kTryEvery;
  if (!opened) {
    if (trouble_ != opened.error().what)
      set_state(CameraState::kFailed, cause_of_failure(options_.source), opened.error().what);
    return;
  }
  input_ = std::move(*opened);
  last_picture_ = next_count_ = now;
  counted_ = 0;
  if (!out_) fmt::print("{}\n", input_->line());
  if (!out_ && !network_trouble_.empty()) fmt::print("{}\n", network_trouble_);
  set_state(CameraState::kRunning, CameraCause::kNone, network_trouble_);
}

bool CaptureCheck::take_picture(MonoTime now) {
  CaptureFrame seen;
  switch (input_->next(kTurn, seen)) {
    case FrameState::kFrame:
      last_picture_ = now;
      if (status_.state != CameraState::kRunning)
        set_state(CameraState::kRunning, CameraCause::kNone, network_trouble_);
      look(seen.left, mono_now());
      return true;
    case FrameState::kGone:
      if (status_.state != CameraState::kUnplugged)
        set_state(CameraState::kUnplugged, CameraCause::kNone, input_->name() + " is gone");
      last_picture_ = now;
      return true;
    case FrameState::kBack:
      shake_.reset();
      if (estimator_) estimator_->reset();
      return true;
    case FrameState::kNone:
      if (now - last_picture_ > kNoPictures && status_.state == CameraState::kRunning)
        set_state(CameraState::kSilent, CameraCause::kNone, input_->name() + " gives no pictures");
      return true;
    case FrameState::kOver:
      return false;
  }
  return false;
}

// How many pictures the camera gives, those that nobody took too.
void CaptureCheck::count(MonoTime now) {
  if (now - next_count_ < kCountEvery) return;
  const FrameCounters counters = input_->counters();
  const std::uint64_t all = counters.taken + counters.outrun + counters.lost;
  const auto seconds = static_cast<float>((now - next_count_).as_seconds());
  facts_.pictures_hz = std::min(1000.0f, static_cast<float>(all - counted_) / seconds);
  counted_ = all;
  next_count_ = now;
}

PreviewPicture CaptureCheck::make_small(const cv::Mat& picture) {
  const double scale = std::min({1.0, static_cast<double>(kSmallWidth_px) / picture.cols,
                                 static_cast<double>(kSmallHeight_px) / picture.rows});
  const cv::Size size(std::max(1, static_cast<int>(picture.cols * scale)),
                      std::max(1, static_cast<int>(picture.rows * scale)));
  cv::resize(picture, small_, size, 0, 0, cv::INTER_AREA);
  cv::cvtColor(small_, rgb_, cv::COLOR_BGR2RGB);
  cv::cvtColor(small_, luma_, cv::COLOR_BGR2GRAY);
  return {rgb_.cols, rgb_.rows, {rgb_.data, rgb_.total() * rgb_.elemSize()}};
}

void CaptureCheck::look(const Frame& frame, MonoTime now) {
  count(now);
  if (now < next_view_) return;
  next_view_ = now + kViewEvery;
  ++pictures_;
  facts_.body = {};
  if (estimator_) facts_.body = seen_body(estimator_->estimate(frame), frame.image.size());
  if (facts_.body.is_found) ++bodies_;
  const PreviewPicture picture = make_small(frame.image);
  facts_.time = frame.capture_time;
  facts_.light = light_of(luma_, facts_.body);
  facts_.shake = std::min(100.0f, shake_.see(luma_, facts_.body, frame.capture_time));
  tell(facts_, picture, now);
}

void CaptureCheck::tell(const CameraFacts& facts, const PreviewPicture& picture, MonoTime now) {
  if (out_) return out_->put(facts, picture);
  advice_.see(facts, now);
  print_news();
}

// A line for each text that was not said before.
void CaptureCheck::print_news() {
  if (out_) return;
  const std::span<const Text> texts = advice_.texts();
  const Texts words(language_of_user());
  for (const Text text : texts)
    if (std::find(printed_.begin(), printed_.end(), text) == printed_.end())
      fmt::print("{}\n", words[text]);
  printed_.assign(texts.begin(), texts.end());
  if (status_.state == CameraState::kFailed) fmt::print("  {}\n", trouble_);
  std::fflush(stdout);
}

void CaptureCheck::print_numbers() const {
  if (out_) return;
  fmt::print("{} pictures looked at, a body in {}; {:.0f} pictures a second, light {:.2f}",
             pictures_, bodies_, facts_.pictures_hz, facts_.light.mean);
  const BodyInFrame body = body_in_frame(facts_.body);
  if (body.is_found) fmt::print(", body {:.0f} % of the picture's height", 100.0f * body.height);
  fmt::print("\n");
}

Result<void> CaptureCheck::run() {
  open_estimator();
  set_state(CameraState::kOpening, CameraCause::kNone, "");
  if (options_.seconds > 0.0) end_ = mono_now() + Duration::seconds(options_.seconds);
  while (!poller_->is_stopped()) {
    const MonoTime now = mono_now();
    if (end_.is_set() && now >= end_) break;
    if (!input_) try_camera(now);
    if (input_ && !take_picture(now)) break;
    poller_->run_once(input_ ? Duration() : kTurn);
    if (out_) out_->flush();
    if (out_ && out_->is_closed()) return {};
  }
  if (pictures_ == 0) return fail(trouble_.empty() ? "no picture came" : trouble_);
  print_numbers();
  return {};
}

}  // namespace dance
