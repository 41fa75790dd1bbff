#include "producers/camera/program/capture_program.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"
#include "producers/camera/program/capture_preview.h"

namespace dance {
namespace {

// Without pictures this is how often the program checks whether it has to stop.
constexpr Duration kFrameTimeout = Duration::ms(50);
constexpr Duration kSilence = Duration::s(3);
constexpr Duration kTroubleEvery = Duration::s(1);

nlohmann::ordered_json dancers_json(const CaptureChain& chain) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const auto& dancer : chain.dancers()) {
    const DancerStats& stats = dancer->stats();
    all.push_back(
        {{"guest", std::string(dancer->guest().view())},
         {"seen", stats.seen},
         {"poses", stats.published},
         {"dequeued_to_published_p50_ms", stats.dequeued_to_published.percentile(0.5).as_ms()},
         {"dequeued_to_published_p99_ms", stats.dequeued_to_published.percentile(0.99).as_ms()},
         {"standing_height_m", standing_height_m(dancer->solver().skeleton())}});
  }
  return all;
}

nlohmann::ordered_json also_json(const OtherCameras& others) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  for (const OtherCameraReport& camera : others.reports()) {
    nlohmann::ordered_json one{{"source", camera.name},
                               {"pictures", camera.pictures},
                               {"seen", camera.seen},
                               {"placed", camera.placement.has_value()},
                               {"moves", camera.moves}};
    if (const auto& placement = camera.placement) {
      const RelativePose& pose = placement->pose;
      const Eigen::Vector3d p_m = placement->p_AB_m();
      const Eigen::Quaterniond R_AB(pose.R_BA.transpose());
      one["p_AB_m"] = {p_m.x(), p_m.y(), p_m.z()};
      one["R_AB_xyzw"] = {R_AB.x(), R_AB.y(), R_AB.z(), R_AB.w()};
      one["angle_deg"] = placement->angle_rad * kDegrees;
      one["turn_sd_deg"] = placement->turn_sd_rad * kDegrees;
      one["later_ms"] = 1e3 * pose.later_s;
      one["spread"] = placement->spread;
    }
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace

Result<std::unique_ptr<CaptureProgram>> CaptureProgram::open(const CaptureOptions& options) {
  std::unique_ptr<CaptureProgram> program(new CaptureProgram(options));
  DANCE_TRY(program->dancers_, wished_dancers(options));
  // Before any thread is started, as these inherit the blocked signals.
  DANCE_TRY(program->poller_, Poller::create());
  if (auto stops = program->poller_->stop_on_signals(); !stops)
    return tl::make_unexpected(stops.error());
  DANCE_TRY(program->input_, CaptureInput::open(options));
  DANCE_TRY(program->preview_,
            open_preview(options, PreviewSide::kAsTheStageShows,
                         program->names() + " before " + program->input_->name()));
  if (auto opened = program->open_chain(); !opened) return tl::make_unexpected(opened.error());
  program->say_what_runs();
  return program;
}

Result<void> CaptureProgram::open_chain() {
  // First what fails without side effects; a recording creates files.
  if (input_->cameras() > 1 && dancers_.size() > 1)
    return fail("a stereo camera sees one dancer; name one guest");
  if (input_->cameras() > 1 && !options_.also.empty())
    return fail("--also and a stereo camera: give one of them");
  EstimatorOptions seeing = networks_of(options_);
  DANCE_TRY(seeing.follow,
            follow_options(options_, input_->format().width_px, input_->format().height_px));
  DANCE_TRY(auto source, open_landmark_source(seeing, dancers_.size()));
  if (!options_.also.empty()) {
    DANCE_TRY(others_, OtherCameras::open(options_, input_->camera()));
  }
  DANCE_TRY(bus_, Bus::open(options_.bus));
  port_ = std::make_unique<HousePublisher>(*bus_, bus_->url(), *poller_);
  bus_sink_ = std::make_unique<PortCaptureSink>(*port_);
  CaptureSink* sink = bus_sink_.get();
  if (!options_.record_folder.empty()) {
    DANCE_TRY(recording_,
              CaptureRecording::create(options_.record_folder, input_->format().hz, *sink));
    sink = recording_.get();
  }
  std::vector<std::unique_ptr<DancerCapture>> dancers;
  for (const WishedDancer& dancer : dancers_)
    dancers.push_back(std::make_unique<DancerCapture>(dancer.guest, *sink));
  chain_ = std::make_unique<CaptureChain>(std::move(source), std::move(dancers));
  make_solvers();
  if (others_) chain_->first().enable_others(*others_);
  if (input_->rig()) chain_->first().enable_stereo(std::make_unique<StereoDepth>(*input_->rig()));
  if (auto opened = open_extras(); !opened) return opened;
  poller_->watch(bus_->fd(), [bus = bus_.get()](MonoTime now) { bus->drain(now); });
  return {};
}

Result<void> CaptureProgram::open_extras() {
  using Wish = CaptureOptions::Hands;
  const std::string folder = pose_models_folder(options_.models_folder);
  const bool may_lack = options_.hands == Wish::kWhereTheirNetworksAre;
  if (may_lack && !HandNetworks::are_in(folder)) {
    talk::info("hands are not seen: their networks are missing; `dance fetch-models` fetches them");
  } else if (options_.hands != Wish::kOff) {
    DANCE_TRY(extras_.hands, HandNetworks::open(options_.engine, folder));
  }
  if (options_.has_face) {
    DANCE_TRY(extras_.face, FaceNetworks::open(options_.engine, folder));
    talk::info("the face is seen: 52 numbers of its expression and the head's turn go to the room");
  }
  const bool has_extras = extras_.hands || extras_.face;
  extras_.load = LoadSteps(has_extras ? LoadStep::kAll : LoadStep::kBodyOnly,
                           dancers_.size() > 1 ? LoadStep::kDancersByTurns : LoadStep::kBodyOnly,
                           dancers_.size());
  if (!has_extras) return {};
  for (const auto& dancer : chain_->dancers())
    dancer->enable_extras(std::make_unique<HandsAndFace>(
        extras_, ExtraOptions{options_.smooth, options_.is_mirrored}));
  return {};
}

void CaptureProgram::make_solvers() {
  const auto shared = dancers_.size() > 1 ? make_shared_placement() : nullptr;
  for (std::size_t i = 0; i < dancers_.size(); ++i) {
    SolverOptions solving;
    if (dancers_[i].height_m > 0.0) solving.height_m = dancers_[i].height_m;
    solving.is_mirrored = options_.is_mirrored;
    solving.smooth = options_.smooth;
    chain_->dancers()[i]->use(std::make_unique<BodySolver>(solving, input_->camera(), shared));
  }
}

std::string CaptureProgram::names() const {
  std::string names;
  for (std::size_t i = 0; i < dancers_.size(); ++i)
    names += (i == 0                    ? ""
              : i + 1 < dancers_.size() ? ", "
                                        : " and ") +
             std::string(dancers_[i].guest.view());
  return names;
}

void CaptureProgram::say_what_runs() const {
  talk::info("{}", input_->line());
  if (!input_->camera().is_measured)
    talk::info("the lens is not measured: {:g} degrees across are assumed (--fov, or --calibrate)",
               options_.fov_deg);
  const bool are_several = dancers_.size() > 1;
  talk::info("pose network {} on {}; {} {} on POSE/capture/{}; Ctrl-C ends it",
             name_of(options_.model), name_of(chosen_engine(options_.engine)), names(),
             are_several ? "dance" : "dances",
             are_several ? "…" : std::string(dancers_.front().guest.view()));
}

void CaptureProgram::run() {
  begin_ = mono_now();
  last_picture_ = begin_;
  if (options_.seconds > 0.0) end_ = begin_ + Duration::seconds(options_.seconds);
  CaptureFrame seen;
  bool is_over = false;
  if (others_) others_->start();
  while (!is_over && !poller_->is_stopped()) {
    switch (input_->next(kFrameTimeout, seen)) {
      case FrameState::kFrame:
        look(seen);
        break;
      case FrameState::kNone:
        break;
      case FrameState::kGone:
        if (!has_said_gone_)
          talk::warn("{} is gone; plug it in again, it is looked for", input_->name());
        has_said_gone_ = true;
        break;
      case FrameState::kBack:
        talk::info("{} is back", input_->name());
        chain_->restart();
        has_said_silence_ = has_said_gone_ = false;
        last_picture_ = mono_now();
        break;
      case FrameState::kOver:
        is_over = true;
        break;
    }
    poller_->run_once(Duration());  // the bus, and whether to stop
    const MonoTime now = mono_now();
    if (now >= next_look_at_trouble_) say_trouble(now);
    if (end_.is_set() && now >= end_) is_over = true;
    if (preview_ && preview_->was_closed()) is_over = true;
  }
  if (recording_) recording_->finish();
  say_trouble(mono_now());  // of the last pictures, too: a full disk
  report();
}

// A camera that comes back in a slower socket may give another size: the lens is then that of this
// size.
bool CaptureProgram::has_usual_size(const cv::Mat& picture) {
  const FrameFormat& format = input_->format();
  if (picture.cols == format.width_px && picture.rows == format.height_px) return true;
  if (auto taken = input_->take_size(picture.cols, picture.rows); !taken) {
    if (!has_said_size_) talk::warn("{}", taken.error().what);
    has_said_size_ = true;
    return false;
  }
  talk::info("{} gives {}x{} now; the dancer is measured again", input_->name(), picture.cols,
             picture.rows);
  make_solvers();
  chain_->restart();
  if (others_) {
    others_->set_first(input_->camera());
    others_->reset_body();
  }
  return true;
}

void CaptureProgram::look(const CaptureFrame& seen) {
  const MonoTime before = std::exchange(last_picture_, mono_now());
  has_said_silence_ = false;
  if (!has_usual_size(seen.left.image)) return;
  chain_->see(seen.left, seen.right.empty() ? nullptr : &seen.right);
  const MonoTime now = mono_now();
  if (extras_.load.add(now - seen.left.fetched, last_picture_ - before, now)) {
    talk::info("this machine's speed: {}", text_of(extras_.load.step()));
    const bool are_by_turns = extras_.load.step() == LoadStep::kDancersByTurns;
    chain_->source().set_turns(are_by_turns ? dancers_.size() : 1);
  }
  // The pose is sent; nothing below blocks.
  const std::string_view advice = advice_.see(seen.left.image, chain_->bodies().front());
  if (!advice.empty()) talk::info("{}", advice);
  if (preview_) {
    const double seconds = std::max(0.1, (last_picture_ - begin_).as_seconds());
    preview_->show(
        seen.left, chain_->bodies(),
        fmt::format("{}  {:.0f} Hz  {:.1f} ms", names(),
                    static_cast<double>(chain_->pictures()) / seconds,
                    chain_->first().stats().dequeued_to_published.percentile(0.5).as_ms()));
  }
  if (recording_) recording_->add(seen.left);
}

// Each is said once.
void CaptureProgram::say_trouble(MonoTime now) {
  next_look_at_trouble_ = now + kTroubleEvery;
  if (!has_said_silence_ && !has_said_gone_ && now - last_picture_ > kSilence) {
    has_said_silence_ = true;
    talk::warn(
        "{} gives no pictures; is another program using it, or the line too slow for {}x{}? Try "
        "--size 640x480",
        input_->name(), input_->format().width_px, input_->format().height_px);
  }
  const auto say_once = [](bool& said, const std::string& trouble) {
    if (said || trouble.empty()) return;
    said = true;
    talk::warn("{}", trouble);
  };
  if (recording_) say_once(has_said_recording_, recording_->trouble());
  if (preview_) say_once(has_said_preview_, preview_->trouble());
  say_once(has_said_input_, input_->trouble());
  if (const std::string news = others_ ? others_->news() : ""; !news.empty())
    talk::info("{}", news);
  if (const StereoDepth* stereo = chain_->first().stereo())
    say_once(has_said_stereo_, stereo->trouble());
}

void CaptureProgram::report() const {
  const DancerStats& stats = chain_->first().stats();
  const FrameCounters counters = input_->counters();
  const double seconds = (mono_now() - begin_).as_seconds();
  const double hz = seconds > 0.0 ? static_cast<double>(chain_->pictures()) / seconds : 0.0;
  const auto ms = [](const Histogram& h, double fraction) {
    return h.percentile(fraction).as_ms();
  };
  talk::info(
      "{} pictures ({:.1f} Hz), a dancer in {}, {} poses; picture to bus {:.1f} ms p50, {:.1f} ms "
      "p99",
      chain_->pictures(), hz, stats.seen, stats.published, ms(stats.dequeued_to_published, 0.5),
      ms(stats.dequeued_to_published, 0.99));
  for (std::size_t i = 1; i < dancers_.size(); ++i) {
    const DancerStats& other = chain_->dancers()[i]->stats();
    talk::info("{} in {}, {} poses; picture to bus {:.1f} ms p50, {:.1f} ms p99",
               dancers_[i].guest.view(), other.seen, other.published,
               ms(other.dequeued_to_published, 0.5), ms(other.dequeued_to_published, 0.99));
  }
  if (counters.outrun + counters.lost + counters.damaged + counters.unplugged > 0)
    talk::info(
        "{} pictures were outrun by newer ones, {} lost in the driver, {} damaged; unplugged {} "
        "times",
        counters.outrun, counters.lost, counters.damaged, counters.unplugged);
  if (recording_) talk::info("{}: {}", options_.record_folder, recording_->summary());
  if (!options_.wants_json) return;
  const CameraStand stand = chain_->first().solver().camera_stand();
  nlohmann::ordered_json json{
      {"source", input_->name()},
      {"seconds", seconds},
      {"pictures", chain_->pictures()},
      {"hz", hz},
      {"seen", stats.seen},
      {"poses", stats.published},
      {"dequeued_to_published_p50_ms", ms(stats.dequeued_to_published, 0.5)},
      {"dequeued_to_published_p99_ms", ms(stats.dequeued_to_published, 0.99)},
      {"captured_to_published_p50_ms", ms(stats.captured_to_published, 0.5)},
      {"captured_to_published_p99_ms", ms(stats.captured_to_published, 0.99)},
      {"outrun", counters.outrun},
      {"lost", counters.lost},
      {"damaged", counters.damaged},
      {"unplugged", counters.unplugged},
      {"searches", chain_->source().searches()},
      {"camera_height_m", stand.height_m},
      {"camera_pitch_deg", stand.pitch_rad * 180.0 / std::numbers::pi},
      {"standing_height_m", standing_height_m(chain_->first().solver().skeleton())}};
  if (const StereoDepth* stereo = chain_->first().stereo())
    json["stereo_hints"] = stereo->counters().hinted;
  if (dancers_.size() > 1) json["dancers"] = dancers_json(*chain_);
  if (others_) json["also"] = also_json(*others_);
  std::printf("%s\n", json.dump().c_str());
}

}  // namespace dance
