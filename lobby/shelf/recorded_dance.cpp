#include "lobby/shelf/recorded_dance.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "core/base/text/plain_text.h"
#include "core/bus/channel.h"
#include "core/bus/encode.h"
#include "formats/log/packed_event.h"

namespace dance {
namespace {

constexpr std::size_t kPart_bytes = std::size_t{64} << 10;
constexpr std::size_t kParts = kMostRead_bytes / kPart_bytes;
constexpr std::int64_t kLatest_us = 4'102'444'800'000'000;  // the year 2100
constexpr Duration kLongest = Duration::s(48 * 3600);

class OpenFile {
 public:
  // A pipe or a device would wait, or never end.
  explicit OpenFile(const std::string& path)
      : fd_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {
    struct stat facts {};
    if (fd_ < 0 || fstat(fd_, &facts) != 0 || !S_ISREG(facts.st_mode)) return;
    size_ = static_cast<std::uint64_t>(std::max<off_t>(facts.st_size, 0));
  }
  ~OpenFile() {
    if (fd_ >= 0) close(fd_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  std::uint64_t size() const { return size_; }  // 0 = nothing to read
  void read(std::uint64_t at, std::vector<std::uint8_t>& part) const {
    part.resize(kPart_bytes);
    const ssize_t count = pread(fd_, part.data(), part.size(), static_cast<off_t>(at));
    part.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  }

 private:
  int fd_;
  std::uint64_t size_ = 0;
};

// Collects the facts from the events of all samples.
class Facts {
 public:
  explicit Facts(RecordedDance& dance) : dance_(dance) {}

  void take(const LogEvent& event) {
    if (event.time_us <= 0 || event.time_us > kLatest_us) return;
    std::string_view name = event.channel;
    const bool was_packed = is_packed(event);
    if (was_packed) name.remove_prefix(kPackedPrefix.size());
    const auto channel = Channel::parse(name);
    if (!channel) return;
    first_us_ = first_us_ == 0 ? event.time_us : std::min(first_us_, event.time_us);
    last_us_ = std::max(last_us_, event.time_us);
    if (channel->signal() == Signal::kPose) add_guest(channel->guest());
    if (was_packed) return;
    if (channel->signal() == Signal::kMusic) take_music(event);
    if (channel->signal() == Signal::kProfile) take_profile(channel->guest(), event);
    if (channel->signal() == Signal::kBeat) take_beat(event);
  }
  void finish() {
    if (first_us_ == 0) return;
    dance_.begun_us = first_us_;
    const Duration length = Duration::us(last_us_ - first_us_);
    if (length <= kLongest) dance_.length = length;
  }

 private:
  void add_guest(const GuestId& guest) {
    dance_.has_motion = true;
    auto& guests = dance_.guests;
    if (guests.size() < RecordedDance::kMostGuests &&
        std::find(guests.begin(), guests.end(), guest.view()) == guests.end())
      guests.emplace_back(guest.view());
  }
  // Keeps the first song that has a title.
  void take_music(const LogEvent& event) {
    Music music;
    if (decode(event.data.data(), event.data.size(), music) != Decoded::kFine) return;
    if (dance_.song.empty()) dance_.song = plain_text(music.title.view());
  }
  void take_profile(const GuestId& guest, const LogEvent& event) {
    Profile profile;
    if (decode(event.data.data(), event.data.size(), profile) != Decoded::kFine) return;
    auto& names = dance_.shown_names;
    const std::string id(guest.view());
    if (!profile.shown_name.empty() &&
        (names.size() < RecordedDance::kMostGuests || names.contains(id)))
      names[id] = profile.shown_name.view();
  }
  void take_beat(const LogEvent& event) {
    Beat beat;
    if (decode(event.data.data(), event.data.size(), beat) != Decoded::kFine) return;
    if (beat.playing && dance_.tempo_bpm <= 0.0) dance_.tempo_bpm = beat.tempo_bpm;
  }

  RecordedDance& dance_;
  std::int64_t first_us_ = 0, last_us_ = 0;  // 0 = no event yet
};

}  // namespace

std::string RecordedDance::name() const {
  std::string name = path.substr(path.rfind('/') + 1);
  if (name.ends_with(".lcm")) name.resize(name.size() - 4);
  return plain_text(name);
}

void read_dance(RecordedDance& dance) {
  dance.is_read = true;
  const OpenFile file(dance.path);
  if (file.size() == 0) return;
  Facts facts(dance);
  std::vector<std::uint8_t> part;
  const std::uint64_t last = file.size() - std::min<std::uint64_t>(file.size(), kPart_bytes);
  std::optional<std::uint64_t> before;
  for (std::size_t i = 0; i < kParts; ++i) {
    const std::uint64_t at = last / (kParts - 1) * i + last % (kParts - 1) * i / (kParts - 1);
    if (before == at) continue;  // the parts of a short file are the same
    before = at;
    file.read(at, part);
    LogReader reader = LogReader::over(part);
    while (const auto event = reader.next()) facts.take(*event);
  }
  facts.finish();
}

}  // namespace dance
