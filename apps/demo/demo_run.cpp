#include "apps/demo/demo_run.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "core/store/folder_entries.h"
#include "testing/line/line_options.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr Duration kConnectTimeout = Duration::s(15);  // for the houses to connect
constexpr Duration kPicturesTimeout = Duration::s(60);
constexpr Duration kMusicTimeout = Duration::s(5);
constexpr Duration kRestartAfter = Duration::ms(500);
constexpr Duration kLongestWay = Duration::ms(1500);  // that a pose may take to arrive

std::string read_file(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// stage-0001.png and so on: other files in the folder are not the demo's.
bool is_viewer_picture(const std::string& name) {
  constexpr std::string_view kBegin = "stage-", kEnd = ".png";
  if (!name.starts_with(kBegin) || !name.ends_with(kEnd)) return false;
  const std::string number = name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size());
  return number.size() == 4 && number.find_first_not_of("0123456789") == std::string::npos;
}

std::vector<std::string> pictures_in(const std::string& folder) {
  std::vector<std::string> pictures;
  std::error_code error;
  for (const auto& entry : folder_entries(folder, error))
    if (is_viewer_picture(entry.path().filename().string()))
      pictures.push_back(entry.path().string());
  std::sort(pictures.begin(), pictures.end());
  return pictures;
}

// Early, in the middle and late in the dance; the viewer needs a moment to open. Behind the first
// there is time to draw it, so that it is there while the dance goes on.
std::string picture_moments(double seconds) {
  std::ostringstream text;
  text << 0.2 * seconds << "," << 0.6 * seconds << "," << 0.8 * seconds;
  return text.str();
}

}  // namespace

Result<std::unique_ptr<DemoRun>> DemoRun::prepare(const DemoOptions& options, DemoPlan plan) {
  std::unique_ptr<DemoRun> run(new DemoRun(options, std::move(plan)));
  DANCE_TRY(run->poller_, Poller::create());
  if (auto stops = run->poller_->stop_on_signals(); !stops)
    return tl::make_unexpected(stops.error());
  DANCE_TRY(run->bus_a_, Bus::open(run->plan_.bus_url[0]));
  DANCE_TRY(run->bus_b_, Bus::open(run->plan_.bus_url[1]));
  run->monitor_ = std::make_unique<DemoMonitor>(*run->bus_a_, *run->bus_b_);
  if (options.compare)
    run->trace_ = std::make_unique<DemoTrace>(
        *run->bus_a_, *run->bus_b_, run->plan_.dancers[0].guest, run->plan_.dancers[1].guest);
  for (Bus* bus : {run->bus_a_.get(), run->bus_b_.get()})
    run->poller_->watch(bus->fd(), [bus](MonoTime now) { bus->drain(now); });
  return run;
}

DemoRun::DemoRun(const DemoOptions& options, DemoPlan plan)
    : options_(options), plan_(std::move(plan)) {
  std::error_code ignored;  // the viewer reports what it cannot write
  for (const std::string& picture : pictures_in(options_.out)) fs::remove(picture, ignored);
}

DemoRun::Role& DemoRun::add(const std::string& name, const std::string& program,
                            std::vector<std::string> arguments) {
  auto role = std::make_unique<Role>();
  role->name = name;
  role->how.program = program_folder() + "/" + program;
  role->how.arguments = std::move(arguments);
  role->how.output_file = report_file(name);
  role->how.talk_file = programs_folder(options_) + "/" + name + ".txt";
  std::error_code error;
  fs::remove(role->how.output_file, error);
  fs::remove(role->how.talk_file, error);
  roles_.push_back(std::move(role));
  return *roles_.back();
}

Result<void> DemoRun::start(Role& role) {
  DANCE_TRY(ChildProcess process, ChildProcess::start(role.how));
  role.process = std::make_unique<ChildProcess>(std::move(process));
  role.restart_at = MonoTime();
  return {};
}

Result<void> DemoRun::start_houses() {
  const std::string server = "127.0.0.1:" + std::to_string(plan_.server_port);
  std::vector<Role*> started{
      &add("server", "dance-server",
           {"--bind", "127.0.0.1", "--port", std::to_string(plan_.server_port)})};
  if (plan_.line_port != 0) {
    std::vector<std::string> arguments{"--listen", "127.0.0.1:" + std::to_string(plan_.line_port),
                                       "--to", server, "--json"};
    for (std::string& word : line_arguments(options_.line)) arguments.push_back(std::move(word));
    started.push_back(&add("line", "dance-lossy", arguments));
  }
  for (int house = 0; house < 2; ++house)
    started.push_back(&add(house == 0 ? "house-a" : "house-b", "dance-join",
                           {plan_.session_file[house], "--no-view", "--json"}));
  started.push_back(&add("record", "dance-record",
                         {"--append", "-o", plan_.log_file, "--bus", plan_.bus_url[0]}));
  for (Role* role : started)
    if (auto result = start(*role); !result) return result;
  return {};
}

Result<void> DemoRun::wait_until_connected() {
  const MonoTime give_up = mono_now() + kConnectTimeout;
  while (!poller_->is_stopped()) {
    if (monitor_->is_connected(0) && monitor_->is_connected(1)) return {};
    for (const auto& role : roles_)
      if (role->process && role->process->has_ended())
        return fail(role->name + " " + role->process->exit_text() + ": " +
                    read_file(role->how.talk_file));
    if (mono_now() > give_up)
      return fail("the houses did not reach the server within 15 s; " + programs_folder(options_) +
                  "/house-a.txt and house-b.txt say why");
    poller_->run_once(Duration::ms(50));
  }
  return {};
}

// House A plays for the room; house B follows it through the tunnel by its own clock.
Result<void> DemoRun::start_music() {
  if (plan_.song.empty()) {
    beats_ = std::make_unique<DemoBeats>(*bus_a_, *bus_b_, mono_now(), options_.tempo_bpm);
    poller_->add_timer(mono_now(), [this](MonoTime now) { return beats_->say(now); });
    return {};
  }
  for (int house = 0; house < 2; ++house) {
    std::vector<std::string> arguments{
        plan_.song, "--loop",
        "--bus",    plan_.bus_url[house],
        "--guest",  std::string(plan_.dancers[static_cast<std::size_t>(house)].guest.view())};
    if (house == 0) arguments.insert(arguments.end(), {"--start", "+500ms"});
    if (house == 1) arguments.push_back("--follow");
    // One loudspeaker is enough for one machine.
    if (house == 1 || options_.headless) arguments.push_back("--silent");
    Role& role = add(house == 0 ? "music-a" : "music-b", "dance-music", arguments);
    if (auto started = start(role); !started) return started;
  }
  return {};
}

// Dancers begin when they have something to dance to; after a while without it too.
void DemoRun::wait_for_music() {
  const MonoTime give_up = mono_now() + kMusicTimeout;
  while (!poller_->is_stopped() && mono_now() < give_up &&
         !(monitor_->has_music(0) && monitor_->has_music(1)))
    poller_->run_once(Duration::ms(20));
}

Result<void> DemoRun::start_dancers(MonoTime origin) {
  for (const DemoDancer& dancer : plan_.dancers) {
    std::vector<std::string> arguments = dancer.arguments;
    for (const std::string& argument :
         {std::string("--guest"), std::string(dancer.guest.view()), std::string("--bus"),
          plan_.bus_url[dancer.house], std::string("--hz"), std::to_string(options_.hz),
          std::string("--start-us"), std::to_string(origin.since_zero_us())})
      arguments.push_back(argument);
    Role& role = add(std::string(dancer.guest.view()), dancer.program, arguments);
    dancers_.push_back(&role);
    if (auto result = start(role); !result) return result;
  }
  return {};
}

Result<void> DemoRun::start_viewer() {
  if (!options_.view) return {};
  std::vector<std::string> arguments{"--bus", plan_.bus_url[0]};
  if (options_.compare) arguments.push_back("--compare");
  if (options_.headless)
    for (const std::string& argument :
         {std::string("--headless"), std::string("--out"), options_.out, std::string("--at"),
          picture_moments(options_.seconds), std::string("--size"), std::string("1280x720")})
      arguments.push_back(argument);
  viewer_ = &add("view", "dance-view", arguments);
  return start(*viewer_);
}

// Restarts programs that ended; returns when to look again.
MonoTime DemoRun::restart_ended(MonoTime now) {
  if (ending_) return {};
  for (const auto& role : roles_) {
    if (role->is_over) continue;
    if (role->restart_at.is_set()) {
      if (now < role->restart_at) continue;
      talk::info("{}: restarted", role->name);
      if (auto result = start(*role); !result) {
        talk::error("{}", result.error().what);
        role->restart_at = now + Duration::s(1);
      }
      ++restarts_;
      continue;
    }
    if (!role->process->has_ended()) continue;
    if (role->process->ended_well()) {
      role->is_over = true;
      if (role.get() == viewer_ && !options_.headless) poller_->stop();  // the window was closed
      continue;
    }
    talk::warn("{} {}; the others go on", role->name, role->process->exit_text());
    role->restart_at = now + kRestartAfter;
  }
  return now + Duration::ms(100);
}

void DemoRun::run_until(MonoTime deadline) {
  while (!poller_->is_stopped()) {
    const MonoTime now = mono_now();
    if (now >= deadline) return;
    poller_->run_once(std::min(deadline - now + Duration::ms(1), Duration::ms(100)));
  }
}

void DemoRun::stop_in_order() {
  // Dancers first, so that every pose that was sent has its chance to arrive; then the rest.
  ending_ = true;
  monitor_->stop_timing();
  if (trace_) trace_->stop();
  for (Role* role : dancers_)
    if (role->process) role->process->ask_to_stop();
  const MonoTime arrived = mono_now() + kLongestWay;
  while (mono_now() < arrived) poller_->run_once(Duration::ms(50));
  // Pictures drawn by the processor take a second or more each: the viewer ends by itself after the
  // last.
  const MonoTime drawn = mono_now() + kPicturesTimeout;
  while (options_.headless && viewer_ && viewer_->process && !poller_->is_stopped() &&
         !viewer_->process->has_ended() && mono_now() < drawn)
    poller_->run_once(Duration::ms(50));
  for (auto role = roles_.rbegin(); role != roles_.rend(); ++role)
    if ((*role)->process) (*role)->process->stop(Duration::s(3));
}

DemoResult DemoRun::result(MonoTime origin) const {
  DemoResult result;
  result.accounts = monitor_->accounts();
  result.seconds = std::max(0.0, (std::min(end_, mono_now()) - origin).as_seconds());
  if (options_.headless) result.pictures = pictures_in(options_.out);
  result.log = plan_.log_file;
  result.restarts = restarts_;
  result.house_reports[0] = read_file(report_file("house-a"));
  result.house_reports[1] = read_file(report_file("house-b"));
  result.line_report = read_file(report_file("line"));
  return result;
}

Result<void> DemoRun::add_comparison(DemoResult& result) const {
  if (!trace_) return {};
  result.rhythm = measure_rhythm(*trace_);
  if (!result.rhythm) {
    talk::info("too little was danced to compare; --seconds 10 is enough");
    return {};
  }
  if (!options_.headless) return {};
  DANCE_TRY(result.comparison, draw_comparison(options_, plan_, *trace_, *result.rhythm));
  return {};
}

Result<DemoResult> DemoRun::run() {
  if (auto started = start_houses(); !started) return tl::make_unexpected(started.error());
  if (auto connected = wait_until_connected(); !connected)
    return tl::make_unexpected(connected.error());
  poller_->add_timer(mono_now(), [this](MonoTime now) { return restart_ended(now); });
  if (auto started = start_music(); !started) return tl::make_unexpected(started.error());
  wait_for_music();
  const MonoTime origin = mono_now() + Duration::ms(300);
  if (auto started = start_viewer(); !started) return tl::make_unexpected(started.error());
  if (auto started = start_dancers(origin); !started) return tl::make_unexpected(started.error());
  talk::info("{} dancers in two houses; Ctrl-C ends it", plan_.dancers.size());
  const bool endless = options_.seconds <= 0.0;
  end_ = origin + (endless ? Duration::s(365 * 24 * 3600) : Duration::seconds(options_.seconds));
  run_until(end_);
  end_ = std::min(end_, mono_now());
  stop_in_order();
  DemoResult ended = result(origin);
  if (auto compared = add_comparison(ended); !compared)
    return tl::make_unexpected(compared.error());
  return ended;
}

}  // namespace dance
