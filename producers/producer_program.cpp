#include "producers/producer_program.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/net/mono_clock.h"

namespace dance {

void add_producer_options(CommandLine& line, ProducerOptions& options) {
  line.add("--bus", options.bus, "LCM URL of the house's bus");
  line.add("--hz", options.hz, "poses a second; 0 = the dancer's own rate").range(0.0, 1000.0);
  line.add("--seconds", options.seconds, "how long; 0 = until told to stop").range(0.0, 1e7);
  line.add("--start-us", options.start_us,
           "when the dance began, in microseconds of this machine's monotonic clock; 0 = "
           "now. Producers that "
           "are given the same start dance in step")
      .range(0.0, 9e18);
}

Result<ProducerPlace> parse_place(const std::string& text) {
  std::array<double, 3> numbers{};
  const char* at = text.data();
  const char* end = at + text.size();
  std::size_t count = 0;
  while (count < numbers.size()) {
    const auto [next, error] = std::from_chars(at, end, numbers[count]);
    if (error != std::errc() || !std::isfinite(numbers[count])) break;
    ++count;
    at = next;
    if (at == end || *at != ',') break;
    ++at;
  }
  if (count < 2 || at != end)
    return fail("'" + text +
                "' is not a place; write x,z or x,z,heading in metres and degrees, like 0.5,-1,90");
  return ProducerPlace{numbers[0], numbers[1], numbers[2]};
}

Result<std::unique_ptr<ProducerProgram>> ProducerProgram::open(const ProducerOptions& options) {
  std::unique_ptr<ProducerProgram> program(new ProducerProgram);
  program->options_ = options;
  DANCE_TRY(program->poller_, Poller::create());
  if (auto stops = program->poller_->stop_on_signals(); !stops)
    return tl::make_unexpected(stops.error());
  DANCE_TRY(program->bus_, Bus::open(options.bus));
  program->port_ =
      std::make_unique<HousePublisher>(*program->bus_, program->bus_->url(), *program->poller_);
  program->sink_ = std::make_unique<PortCaptureSink>(*program->port_);
  program->poller_->watch(program->bus_->fd(),
                          [bus = program->bus_.get()](MonoTime now) { bus->drain(now); });
  program->start_ = options.start_us != 0 ? MonoTime::from_us(options.start_us) : mono_now();
  return program;
}

void ProducerProgram::add(std::unique_ptr<Dancer> dancer, const GuestId& guest) {
  const double hz = options_.hz > 0.0 ? options_.hz : std::clamp(dancer->natural_hz(), 1.0, 1000.0);
  feeds_.push_back(
      std::make_unique<DancerFeed>(std::move(dancer), guest, hz, *sink_, *poller_, start_));
}

void ProducerProgram::run(const std::function<bool()>& is_over) {
  if (options_.seconds > 0.0)
    poller_->add_timer(std::max(start_, mono_now()) + Duration::seconds(options_.seconds),
                       [this](MonoTime) {
                         poller_->stop();
                         return MonoTime();
                       });
  const auto all_over = [&] {
    return is_over() && std::all_of(feeds_.begin(), feeds_.end(),
                                    [](const auto& feed) { return feed->is_over(); });
  };
  while (!poller_->is_stopped() && !all_over()) poller_->run_once(Duration::s(1));
}

std::uint64_t ProducerProgram::sent() const {
  std::uint64_t sum = 0;
  for (const auto& feed : feeds_) sum += feed->sent();
  return sum;
}

}  // namespace dance
