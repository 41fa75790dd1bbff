#include <fmt/format.h>
#include <sys/resource.h>

#include <fstream>
#include <sstream>

#include "bench/voice/bench_voice.h"
#include "core/bus/bus.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/net/udp_socket.h"
#include "core/program/figures.h"
#include "core/program/program.h"
#include "testing/voice/sound_match.h"
#include "testing/voice/sound_rooms.h"

namespace dance {
namespace {

constexpr Duration kEarSettles = Duration::s(4);
constexpr Duration kEarAfter = Duration::ms(700);
constexpr Duration kEarEnds = Duration::s(5);
constexpr int kEarNice = -15;
constexpr double kEarDemand_ms = 60.0;

// Two houses: alice speaks into one room, and is heard in bob's.
class TwoHouses {
 public:
  explicit TwoHouses(const std::string& folder) : folder_(folder) {}
  ~TwoHouses() {
    if (bus_a_) poller_->unwatch(bus_a_->fd());
  }
  TwoHouses(const TwoHouses&) = delete;
  TwoHouses& operator=(const TwoHouses&) = delete;

  // Without a server what one house publishes is handed to the other: what buffers alone take.
  Result<void> start(const std::vector<std::string>& voice_words, bool has_server);
  Result<BenchReport> measure(const char* name, const Speech& speech);
  Result<void> end();

 private:
  Result<void> run(const std::string& name, const std::string& program,
                   const std::vector<std::string>& words);
  void work_for(Duration time, const std::function<bool()>& is_done);
  double cpu_percent(const std::string& name, Duration over) const;
  std::string text_of(const std::string& file) const;

  struct Running {
    std::string name;
    ChildProcess process;
    Duration cpu_before;
  };
  std::string folder_;
  std::string server_, url_a_, url_b_;
  std::unique_ptr<SoundRooms> rooms_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<Bus> bus_a_, bus_b_;
  std::vector<Running> running_;
};

std::string TwoHouses::text_of(const std::string& file) const {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

Result<void> TwoHouses::run(const std::string& name, const std::string& program,
                            const std::vector<std::string>& words) {
  DANCE_TRY(ChildProcess child,
            ChildProcess::start({program_folder() + "/" + program, words,
                                 folder_ + "/" + name + ".out", folder_ + "/" + name + ".talk"}));
  running_.push_back({name, std::move(child), Duration()});
  return {};
}

Result<void> TwoHouses::start(const std::vector<std::string>& voice_words, bool has_server) {
  const auto url = [&](std::uint16_t port) {
    return "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0";
  };
  DANCE_TRY(const std::uint16_t port_a, free_loopback_port());
  DANCE_TRY(const std::uint16_t port_b, free_loopback_port());
  DANCE_TRY(const std::uint16_t port, free_loopback_port());
  url_a_ = url(port_a);
  url_b_ = url(port_b);
  server_ = "127.0.0.1:" + std::to_string(port);
  DANCE_TRY(rooms_, SoundRooms::open(folder_, {"mouth-a", "ear-a", "mouth-b", "ear-b"}));
  DANCE_TRY(poller_, Poller::create());
  if (!has_server) {
    DANCE_TRY(bus_a_, Bus::open(url_a_));
    DANCE_TRY(bus_b_, Bus::open(url_b_));
    bus_a_->subscribe<Voice>(Where::kCapture,
                             [this](const Channel& channel, const Voice& voice, MonoTime) {
                               bus_b_->publish(Where::kGuest, channel.guest(), voice);
                             });
    poller_->watch(bus_a_->fd(), [this](MonoTime now) { bus_a_->drain(now); });
  } else if (auto ran = run("server", "dance-server", {"--port", std::to_string(port)}); !ran)
    return ran;
  for (const bool is_a : {true, false}) {
    const std::string guest = is_a ? "alice" : "bob";
    const std::string& bus = is_a ? url_a_ : url_b_;
    if (has_server) {
      if (auto ran = run("house-" + guest, "dance-join",
                         {server_, "--guest", guest, "--bus", bus, "--no-view"});
          !ran)
        return ran;
    }
    std::vector<std::string> words{"--guest",       guest,
                                   "--bus",         bus,
                                   "--microphone",  is_a ? "mouth-a.monitor" : "mouth-b.monitor",
                                   "--loudspeaker", is_a ? "ear-a" : "ear-b",
                                   "--quiet",       "--json"};
    words.insert(words.end(), voice_words.begin(), voice_words.end());
    if (auto ran = run("voice-" + guest, "dance-voice", words); !ran) return ran;
  }
  return {};
}

void TwoHouses::work_for(Duration time, const std::function<bool()>& is_done) {
  const MonoTime end = mono_now() + time;
  while (mono_now() < end && !is_done()) {
    poller_->run_once(Duration::ms(2));
    rooms_->work(mono_now());
  }
}

double TwoHouses::cpu_percent(const std::string& name, Duration over) const {
  for (const Running& one : running_)
    if (one.name == name)
      return 100.0 * (one.process.cpu_time() - one.cpu_before).as_seconds() / over.as_seconds();
  return 0.0;
}

Result<BenchReport> TwoHouses::measure(const char* name, const Speech& speech) {
  const auto never = [] { return false; };
  work_for(kEarSettles, never);
  DANCE_TRY(const std::size_t mouth, rooms_->listen("mouth-a"));
  DANCE_TRY(const std::size_t ear, rooms_->listen("ear-b"));
  if (auto played = rooms_->play("mouth-a", speech); !played)
    return tl::make_unexpected(played.error());
  for (Running& one : running_) one.cpu_before = one.process.cpu_time();
  const MonoTime begin = mono_now();
  const Duration length = Duration::seconds(static_cast<double>(speech.size()) / 48'000.0);
  work_for(length + Duration::s(30), [&] { return rooms_->has_played(); });
  work_for(kEarAfter, never);
  const Duration over = mono_now() - begin;
  const double cpu_alice = cpu_percent("voice-alice", over);
  const double cpu_bob = cpu_percent("voice-bob", over);
  if (auto ended = end(); !ended) return tl::make_unexpected(ended.error());
  const auto matches =
      match_sound(rooms_->heard(mouth, begin, over), rooms_->heard(ear, begin, over), 0.0, 400.0);
  const MatchFigures figures = figures_of(matches);
  if (figures.fitting == 0)
    return fail("nothing of what alice says is heard at bob's: " +
                text_of(folder_ + "/voice-bob.talk") + text_of(folder_ + "/voice-bob.out"));
  BenchReport report;
  report.text = fmt::format("{:<24} {:>6.1f} ms {:>6.1f} ms {:>5}/{:<5} {:>7.1f}% {:>7.1f}%\n",
                            name, figures.median_ms, figures.p95_ms, figures.fitting,
                            figures.pieces, cpu_alice, cpu_bob);
  report.json = {{"voice", name},
                 {"mouth_to_ear_p50_ms", rounded(figures.median_ms, 10.0)},
                 {"mouth_to_ear_p95_ms", rounded(figures.p95_ms, 10.0)},
                 {"pieces", figures.pieces},
                 {"fitting", figures.fitting},
                 {"speaker_cpu_percent", rounded(cpu_alice, 10.0)},
                 {"listener_cpu_percent", rounded(cpu_bob, 10.0)}};
  for (const char* guest : {"alice", "bob"}) {
    const auto said = nlohmann::ordered_json::parse(text_of(folder_ + "/voice-" + guest + ".out"),
                                                    nullptr, false);
    if (!said.is_discarded()) report.json[guest] = said;
  }
  return report;
}

Result<void> TwoHouses::end() {
  for (auto one = running_.rbegin(); one != running_.rend(); ++one) one->process.stop(kEarEnds);
  return {};
}

}  // namespace

Result<BenchReport> bench_voice_ear(const Speech& speech, const std::string& folder) {
  // Those who speak and hear are to be in time; the programs that are measured inherit it.
  const bool is_favoured = ::setpriority(PRIO_PROCESS, 0, kEarNice) == 0;
  BenchReport report;
  report.text = fmt::format(
      "alice speaks into a microphone, and bob hears her through a server; demanded: {:.0f} ms, "
      "both sound buffers\nincluded. fit: pieces of 400 ms that correlate by 0.5 and more{}\n"
      "{:<24} {:>9} {:>9} {:>11} {:>8} {:>8}\n",
      kEarDemand_ms, is_favoured ? "; all at high priority" : "", "voice", "median", "p95", "fit",
      "speaker", "listener");
  struct EarCase {
    const char* name;
    std::vector<std::string> words;
    bool has_server;
  };
  const std::array cases{EarCase{"as by default", {}, true},
                         EarCase{"without the tunnel", {}, false},
                         EarCase{"--low-delay", {"--low-delay"}, true},
                         EarCase{"--buffer 100", {"--buffer", "100"}, true}};
  for (const auto& [name, words, has_server] : cases) {
    TwoHouses houses(folder);
    if (auto started = houses.start(words, has_server); !started)
      return tl::make_unexpected(started.error());
    DANCE_TRY(const BenchReport one, houses.measure(name, speech));
    report.text += one.text;
    report.json.push_back(one.json);
  }
  return report;
}

}  // namespace dance
