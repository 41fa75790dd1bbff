// dance-record: records a bus to an LCM log that `dance replay`, lcm-logplayer and every LCM tool
// can read.

#include <cstdio>
#include <set>

#include "apps/bus_program.h"
#include "apps/record/recorder.h"
#include "core/base/printable.h"
#include "core/net/clock/recording_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  dance record                                  everything on the bus, until ctrl-C\n"
    "  dance record -o logs/tango.lcm --seconds 60   a minute, into a file of that name\n"
    "  dance record --channels 'POSE/capture/.*' 'SKELETON/capture/.*'\n"
    "  dance record -o logs/ball.lcm --packed        in about a third of the bytes, to the bit\n"
    "  dance replay logs/tango.lcm                   plays it as if the dancers were here\n"
    "Messages longer than a datagram (65 kB) are refused, and their channels named at the end.\n";

struct Options {
  std::string path;
  std::string bus_url;
  double seconds = 0.0;
  std::vector<std::string> channels;
  bool append = false;
  bool packed = false;
};

// Channels whose messages were refused, for the line at the end. Anybody may make up names.
class RefusedChannels {
 public:
  static constexpr std::size_t kMostNames = 16;

  void add(std::string_view name) {
    if (names_.size() < kMostNames) names_.insert(printable(name));
  }
  // "CLOUD/points, MAP/tiles".
  std::string text() const {
    std::string all;
    for (const std::string& name : names_) all += (all.empty() ? "" : ", ") + name;
    return all;
  }

 private:
  std::set<std::string> names_;
};

void report_refused(const Bus::Counters& counters, const RefusedChannels& channels) {
  if (counters.fragments > 0)
    talk::warn(
        "refused {} fragments of messages longer than a datagram (65 kB){}; lcm-logger records "
        "them",
        counters.fragments, channels.text().empty() ? "" : ", on " + channels.text());
  if (counters.malformed > 0)
    talk::warn("refused {} datagrams that are not messages of LCM", counters.malformed);
}

Result<void> record(Options options) {
  DANCE_TRY(RecordFilter filter, RecordFilter::make(options.channels));
  DANCE_TRY(BusProgram program, BusProgram::open(options.bus_url));
  if (options.path.empty()) options.path = default_log_path(std::chrono::system_clock::now());
  DANCE_TRY(Recorder recorder,
            Recorder::make(options.path, std::move(filter),
                           options.append ? Recorder::IfThere::kAppend : Recorder::IfThere::kRefuse,
                           options.packed ? Recorder::Poses::kPacked : Recorder::Poses::kPlain));

  Poller& poller = program.poller();
  const RecordingClock clock;
  program.bus().on_anything(
      [&](std::string_view channel, const void* data, std::size_t size, MonoTime now) {
        recorder.take(clock.wall_us(now), channel, {static_cast<const std::uint8_t*>(data), size});
        if (recorder.failure()) poller.stop();
      });
  RefusedChannels refused;
  program.bus().on_refused([&](std::string_view channel) { refused.add(channel); });
  program.every(Duration::s(1), [&](MonoTime) {
    recorder.flush();
    if (recorder.failure()) poller.stop();
  });
  program.stop_after(options.seconds);
  talk::info("recording {} to {}", program.bus().url(), options.path);
  program.run();
  recorder.flush();
  std::printf("%s: %llu events, %llu bytes\n", options.path.c_str(),
              static_cast<unsigned long long>(recorder.events()),
              static_cast<unsigned long long>(recorder.bytes()));
  if (const auto packing = recorder.packing())
    std::printf("%llu messages packed, %llu not; without --packed %llu bytes\n",
                static_cast<unsigned long long>(packing->packed),
                static_cast<unsigned long long>(packing->kept),
                static_cast<unsigned long long>(packing->plain_bytes));
  report_refused(program.bus().counters(), refused);
  if (recorder.failure()) return tl::make_unexpected(*recorder.failure());
  if (recorder.events() == 0)
    talk::warn("nothing was heard on {}{}: {} {}; dance doctor looks at the bus",
               program.bus().url(), options.channels.empty() ? "" : " of these channels",
               options.path, options.append ? "is as it was" : "is empty");
  return {};
}

// "" where the pattern is fine, else what is wrong.
std::string check_pattern(const std::string& pattern) {
  const auto filter = RecordFilter::make({pattern});
  return filter ? "" : filter.error().what;
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("Records a bus to an LCM log.", "dance record");
  line.add("-o,--output", options.path, "file to write (logs/<date>-<time>.lcm)");
  line.add("--bus", options.bus_url, "LCM URL of the bus");
  line.add("--seconds", options.seconds, "stop after so long (0: ctrl-C)").range(0.0, 1e7);
  line.add_flag("--append", options.append, "go on behind a log that is there already");
  line.add_flag("--packed", options.packed,
                "pack poses and hands to about a third, losing no bit; dance replay plays both");
  line.add("--channels", options.channels, "only channels that match one of these patterns")
      .check(dance::check_pattern);
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::record(options); });
}
