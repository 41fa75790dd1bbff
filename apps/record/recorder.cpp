#include "apps/record/recorder.h"

#include <array>
#include <ctime>
#include <filesystem>

namespace dance {
namespace {

constexpr std::size_t kMaxKnownChannels = 1024;

}  // namespace

std::string default_log_path(std::chrono::system_clock::time_point now) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  std::tm local{};
  localtime_r(&seconds, &local);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), "logs/%Y-%m-%d-%H%M%S.lcm", &local);
  return text.data();
}

Result<RecordFilter> RecordFilter::make(const std::vector<std::string>& patterns) {
  RecordFilter filter;
  for (const std::string& pattern : patterns) {
    try {
      filter.patterns_.emplace_back(pattern, std::regex::ECMAScript | std::regex::optimize);
    } catch (const std::regex_error&) {
      return fail("channel pattern '" + pattern +
                  "' is no regular expression; write one like 'POSE/.*'");
    }
  }
  return filter;
}

bool RecordFilter::wants(std::string_view channel) {
  if (patterns_.empty()) return true;
  if (const auto found = known_.find(channel); found != known_.end()) return found->second;
  bool wanted = false;
  for (const std::regex& pattern : patterns_)
    wanted = wanted || std::regex_match(channel.begin(), channel.end(), pattern);
  if (known_.size() < kMaxKnownChannels) known_.emplace(channel, wanted);
  return wanted;
}

Recorder::Recorder(std::string path, LogWriter writer, RecordFilter filter, Poses poses)
    : path_(std::move(path)),
      writer_(std::move(writer)),
      filter_(std::move(filter)),
      packer_(poses == Poses::kPacked ? std::make_unique<LogPacker>() : nullptr) {}

Result<Recorder> Recorder::make(const std::string& path, RecordFilter filter, IfThere if_there,
                                Poses poses) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty()) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
      return fail(folder.string() + ": cannot be made: " + error.message() +
                  "; name another file with -o");
  }
  DANCE_TRY(LogWriter writer,
            if_there == IfThere::kAppend ? LogWriter::append_to(path) : LogWriter::create(path));
  return Recorder(path, std::move(writer), std::move(filter), poses);
}

void Recorder::take(std::int64_t time_us, std::string_view channel,
                    std::span<const std::uint8_t> data) {
  if (failure_ || !filter_.wants(channel)) return;
  const LogEvent event{static_cast<std::int64_t>(events()), time_us, channel, data};
  note(writer_.append(packer_ ? packer_->pack(event) : event));
}

std::optional<LogPacker::Counters> Recorder::packing() const {
  return packer_ ? std::optional(packer_->counters()) : std::nullopt;
}

void Recorder::flush() {
  if (!failure_) note(writer_.flush());
}

void Recorder::note(Result<void> written) {
  if (!written) failure_ = written.error();
}

}  // namespace dance
