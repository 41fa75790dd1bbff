#include "testing/voice/sound_rooms.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr const char* kPulseProgram = "/usr/bin/pulseaudio";
constexpr std::array kVariables{"XDG_RUNTIME_DIR", "HOME", "PULSE_SERVER"};
constexpr double kRooms_hz = 48'000.0;
constexpr Duration kMostStarting = Duration::s(20);
constexpr Duration kRoomsTiming = Duration::ms(50);

}  // namespace

bool SoundRooms::is_there() { return std::filesystem::exists(kPulseProgram); }

Result<std::unique_ptr<SoundRooms>> SoundRooms::open(const std::string& folder,
                                                     const std::vector<std::string>& sinks,
                                                     const std::vector<Leak>& leaks) {
  if (!is_there()) return fail("there is no pulseaudio: apt-get install pulseaudio");
  std::unique_ptr<SoundRooms> rooms(new SoundRooms);
  const std::string socket = folder + "/native";
  // NOLINTBEGIN(concurrency-mt-unsafe): one thread
  for (const char* name : kVariables) {
    const char* value = std::getenv(name);
    rooms->before_.push_back(value != nullptr ? std::optional<std::string>(value) : std::nullopt);
  }
  ::setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
  ::setenv("HOME", folder.c_str(), 1);
  ::setenv("PULSE_SERVER", ("unix:" + socket).c_str(), 1);
  // NOLINTEND(concurrency-mt-unsafe)
  std::vector<std::string> words{"-n", "--exit-idle-time=-1", "--disable-shm=true"};
  for (const std::string& sink : sinks)
    words.insert(words.end(), {"-L", "module-null-sink sink_name=" + sink + " rate=48000"});
  for (const Leak& leak : leaks)
    words.insert(words.end(), {"-L", "module-loopback source=" + leak.from + ".monitor sink=" +
                                         leak.to + " latency_msec=30 source_dont_move=1"});
  words.insert(words.end(),
               {"-L", "module-native-protocol-unix socket=" + socket + " auth-anonymous=1"});
  DANCE_TRY(ChildProcess child, ChildProcess::start({kPulseProgram, words, folder + "/pulse-output",
                                                     folder + "/pulse-talk"}));
  rooms->child_ = std::make_unique<ChildProcess>(std::move(child));
  const MonoTime end = mono_now() + kMostStarting;
  while (mono_now() < end && !rooms->child_->wait(Duration::ms(50))) {
    auto server = PulseServer::connect("rooms");
    if (!server) continue;
    rooms->server_ = std::move(*server);
    return rooms;
  }
  return fail("pulseaudio does not start; " + folder + "/pulse-talk says why");
}

SoundRooms::~SoundRooms() {
  mouths_.clear();
  ears_.clear();
  server_.reset();
  if (child_) child_->stop(Duration::s(5));
  // NOLINTBEGIN(concurrency-mt-unsafe): one thread
  for (std::size_t i = 0; i < before_.size(); ++i)
    before_[i] ? ::setenv(kVariables[i], before_[i]->c_str(), 1) : ::unsetenv(kVariables[i]);
  // NOLINTEND(concurrency-mt-unsafe)
}

Result<void> SoundRooms::play(const std::string& sink, std::vector<float> mono) {
  auto mouth = std::make_unique<Mouth>();
  mouth->mono = std::move(mono);
  PulseOutputOptions options;
  options.sink = sink;
  options.name = "mouth";
  DANCE_TRY(mouth->output, PulseOutput::open(*server_, options, [](MonoTime, double) {}));
  mouths_.push_back(std::move(mouth));
  return {};
}

Result<std::size_t> SoundRooms::listen(const std::string& sink) {
  auto ear = std::make_unique<Ear>();
  Ear* hears = ear.get();
  DANCE_TRY(ear->input, PulseInput::open(*server_, {sink + ".monitor", kRooms_hz, "ear"},
                                         [hears](std::span<const float> samples) {
                                           hears->samples.insert(hears->samples.end(),
                                                                 samples.begin(), samples.end());
                                         }));
  ears_.push_back(std::move(ear));
  return ears_.size() - 1;
}

void SoundRooms::work(MonoTime now) {
  server_->iterate();
  for (const auto& mouth : mouths_) {
    const std::size_t wanted = mouth->output->wanted_frames();
    std::vector<float> stereo(2 * wanted, 0.0f);
    for (std::size_t i = 0; i < wanted && mouth->at < mouth->mono.size(); ++i, ++mouth->at)
      stereo[2 * i] = stereo[2 * i + 1] = mouth->mono[mouth->at];
    if (wanted > 0) mouth->output->write(stereo);
  }
  if (now < next_timing_) return;
  next_timing_ = now + kRoomsTiming;
  for (const auto& ear : ears_) ear->input->request_timing();
}

bool SoundRooms::has_played() const {
  return std::all_of(mouths_.begin(), mouths_.end(),
                     [](const auto& mouth) { return mouth->at >= mouth->mono.size(); });
}

std::vector<float> SoundRooms::heard(std::size_t ear, MonoTime begin, Duration length) const {
  const Ear& from = *ears_[ear];
  std::vector<float> out(static_cast<std::size_t>(length.as_seconds() * kRooms_hz), 0.0f);
  if (!from.input->is_timed()) return out;
  const auto first =
      static_cast<std::ptrdiff_t>((begin - from.input->time_of(0)).as_seconds() * kRooms_hz);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::ptrdiff_t at = first + static_cast<std::ptrdiff_t>(i);
    if (at >= 0 && at < static_cast<std::ptrdiff_t>(from.samples.size()))
      out[i] = from.samples[static_cast<std::size_t>(at)];
  }
  return out;
}

}  // namespace dance
