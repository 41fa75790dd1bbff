#include "producers/music/sound/pulse_player.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace dance {
namespace {

constexpr std::size_t kBlock_frames = 1024;
constexpr std::size_t kMostBlocksPerTurn = 64;
constexpr Duration kTimingRequests = Duration::ms(100);
constexpr Duration kCorrections = Duration::s(1);

}  // namespace

Result<std::unique_ptr<PulsePlayer>> PulsePlayer::open(AudioFile file,
                                                       const PulsePlayerOptions& options) {
  std::unique_ptr<PulsePlayer> player(new PulsePlayer(std::move(file), options));
  auto server = PulseServer::connect("music");
  if (!server) return fail(server.error().what + "; --silent plays without");
  player->server_ = std::move(*server);
  PulsePlayer* self = player.get();
  PulseOutputOptions stream;
  stream.rate_hz = player->file_.rate_hz();
  auto output = PulseOutput::open(*player->server_, stream, [self](MonoTime at, double frame) {
    self->clock_.report(at + self->options_.trim, frame);
  });
  if (!output) return fail(output.error().what + "; --silent plays without");
  player->output_ = std::move(*output);
  return player;
}

PulsePlayer::PulsePlayer(AudioFile file, const PulsePlayerOptions& options)
    : file_(std::move(file)),
      options_(options),
      clock_(file_.rate_hz()),
      plan_(file_.rate_hz()),
      block_(2 * kBlock_frames),
      gain_(options.volume, file_.rate_hz()) {}

std::optional<double> PulsePlayer::heard_s(MonoTime t) const {
  if (!begin_ || !clock_.is_known()) return std::nullopt;
  return plan_.heard_s(clock_, t);
}

Result<void> PulsePlayer::work(MonoTime now) {
  server_->iterate();
  if (!server_->is_alive() || !output_->is_alive())
    return fail("the connection to the sound server is lost (" + server_->error_text() + ")");
  if (now >= next_timing_request_) {
    output_->request_timing();
    next_timing_request_ = now + kTimingRequests;
  }
  if (begin_ && clock_.is_known()) keep_in_step(now);
  return fill();
}

void PulsePlayer::keep_in_step(MonoTime now) {
  const bool is_first = !plan_.is_aligned();
  if (!is_first && now < next_correction_) return;
  const double error_s = is_first ? 0.0 : plan_.error_s(clock_, *begin_, now);
  if (is_first || PlayPlan::wants_jump(error_s)) {
    if (!is_first) ++jumps_;
    plan_.align(clock_, *begin_, output_->written_frames());
    return;
  }
  next_correction_ = now + kCorrections;
  errors_.add(Duration::seconds(std::abs(error_s)));
  clock_.set_speed(output_->set_speed(PlayPlan::speed_for(error_s)), now);
}

Result<void> PulsePlayer::fill() {
  std::size_t wanted = std::min(output_->wanted_frames(), kMostBlocksPerTurn * kBlock_frames);
  while (wanted > 0) {
    const std::size_t frames = std::min(wanted, kBlock_frames);
    const std::span<float> stereo(block_.data(), 2 * frames);
    std::fill(stereo.begin(), stereo.end(), 0.0f);
    if (begin_ && plan_.is_aligned())
      if (auto read = read_song(plan_.song_frame(output_->written_frames()), stereo); !read)
        return read;
    const std::int64_t before = output_->written_frames();
    output_->write(stereo);
    if (output_->written_frames() == before) break;  // refused: tried again in the next turn
    wanted -= frames;
  }
  return {};
}

// Silence before the song and after it.
Result<void> PulsePlayer::read_song(std::int64_t song_frame, std::span<float> stereo) {
  const std::int64_t length = file_.length_frames();
  auto frames = static_cast<std::int64_t>(stereo.size() / 2);
  if (song_frame < 0) {
    const std::int64_t silent = std::min(-song_frame, frames);
    stereo = stereo.subspan(static_cast<std::size_t>(2 * silent));
    song_frame += silent;
  }
  while (!stereo.empty()) {
    if (song_frame >= length && !loops_) return {};
    const std::int64_t file_frame = song_frame % length;
    if (file_.at_frame() != file_frame)
      if (auto found = file_.seek(file_frame); !found) return found;
    frames =
        std::min<std::int64_t>(static_cast<std::int64_t>(stereo.size() / 2), length - file_frame);
    const auto part = stereo.first(static_cast<std::size_t>(2 * frames));
    DANCE_TRY(const std::size_t read, file_.read_stereo(part));
    gain_.apply(part);
    // A file that holds less than it says: the rest is silence.
    if (read == 0) return {};
    song_frame += frames;
    stereo = stereo.subspan(part.size());
  }
  return {};
}

std::string PulsePlayer::summary() const {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "sound off its time by %.1f ms (median), %.1f ms (worst of 100 s), %llu jumps",
                errors_.percentile(0.5).as_ms(), errors_.percentile(0.99).as_ms(),
                static_cast<unsigned long long>(jumps_ + clock_.jumps()));
  return text.data();
}

}  // namespace dance
