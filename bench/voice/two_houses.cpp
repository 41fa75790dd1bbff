#include "bench/voice/two_houses.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/net/mono_clock.h"
#include "core/net/udp_socket.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr Duration kHousesSettle = Duration::s(4);
constexpr Duration kHousesEnd = Duration::s(5);

}  // namespace

VoiceHouses::~VoiceHouses() {
  if (bus_a_) poller_->unwatch(bus_a_->fd());
  end();
}

void VoiceHouses::end() {
  for (auto one = running_.rbegin(); one != running_.rend(); ++one) one->process.stop(kHousesEnd);
}

std::string VoiceHouses::text_of(const std::string& file) const {
  std::stringstream text;
  text << std::ifstream(folder_ + "/" + file).rdbuf();
  return text.str();
}

Result<void> VoiceHouses::run(const std::string& name, const std::string& program,
                              const std::vector<std::string>& words) {
  // What a run before said is not this one's.
  std::error_code ignored;
  for (const char* end : {".out", ".talk"})
    std::filesystem::remove(folder_ + "/" + name + end, ignored);
  DANCE_TRY(ChildProcess child,
            ChildProcess::start({program_folder() + "/" + program, words,
                                 folder_ + "/" + name + ".out", folder_ + "/" + name + ".talk"}));
  running_.push_back({name, std::move(child), Duration()});
  return {};
}

Result<void> VoiceHouses::hand_over() {
  DANCE_TRY(bus_a_, Bus::open(url_a_));
  DANCE_TRY(bus_b_, Bus::open(url_b_));
  bus_a_->subscribe<Voice>(Where::kCapture,
                           [this](const Channel& channel, const Voice& voice, MonoTime) {
                             bus_b_->publish(Where::kGuest, channel.guest(), voice);
                           });
  poller_->watch(bus_a_->fd(), [this](MonoTime now) { bus_a_->drain(now); });
  return {};
}

Result<void> VoiceHouses::open_house(bool is_a, const Options& options) {
  const std::string guest = is_a ? "alice" : "bob";
  const std::string& bus = is_a ? url_a_ : url_b_;
  if (options.has_server) {
    auto ran =
        run("house-" + guest, "dance-join", {server_, "--guest", guest, "--bus", bus, "--no-view"});
    if (!ran) return ran;
  }
  std::vector<std::string> words{"--guest",       guest,
                                 "--bus",         bus,
                                 "--microphone",  is_a ? "mouth-a.monitor" : "mouth-b.monitor",
                                 "--loudspeaker", is_a ? "ear-a" : "ear-b",
                                 "--quiet",       "--json"};
  words.insert(words.end(), options.voice_words.begin(), options.voice_words.end());
  return run("voice-" + guest, "dance-voice", words);
}

Result<void> VoiceHouses::start(const Options& options) {
  const auto url = [&](std::uint16_t port) {
    return "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0";
  };
  DANCE_TRY(const std::uint16_t port_a, free_loopback_port());
  DANCE_TRY(const std::uint16_t port_b, free_loopback_port());
  DANCE_TRY(const std::uint16_t port, free_loopback_port());
  url_a_ = url(port_a);
  url_b_ = url(port_b);
  server_ = "127.0.0.1:" + std::to_string(port);
  std::vector<SoundRooms::Leak> leaks;
  if (options.bob_hears_his_loudspeaker) leaks = {{"ear-b", "mouth-b"}, {"music-b", "mouth-b"}};
  DANCE_TRY(rooms_,
            SoundRooms::open(folder_, {"mouth-a", "ear-a", "mouth-b", "ear-b", "music-b"}, leaks));
  DANCE_TRY(poller_, Poller::create());
  auto started = options.has_server
                     ? run("server", "dance-server", {"--port", std::to_string(port)})
                     : hand_over();
  if (started) started = open_house(true, options);
  if (started) started = open_house(false, options);
  if (started) work_for(kHousesSettle);
  return started;
}

void VoiceHouses::work_for(Duration time, const std::function<bool()>& is_done) {
  const MonoTime end = mono_now() + time;
  while (mono_now() < end && !is_done()) {
    poller_->run_once(Duration::ms(2));
    rooms_->work(mono_now());
  }
}

void VoiceHouses::begin_to_count_cpu() {
  for (Running& one : running_) one.cpu_before = one.process.cpu_time();
}

double VoiceHouses::cpu_percent(const std::string& program, Duration over) const {
  for (const Running& one : running_)
    if (one.name == program)
      return 100.0 * (one.process.cpu_time() - one.cpu_before).as_seconds() / over.as_seconds();
  return 0.0;
}

}  // namespace dance
