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

Result<std::unique_ptr<PulsePlayer>> PulsePlayer::open(std::unique_ptr<MusicSource> source,
                                                       const PulsePlayerOptions& options) {
  std::unique_ptr<PulsePlayer> player(new PulsePlayer(std::move(source), options));
  auto server = PulseServer::connect("music");
  if (!server) return fail(server.error().what + "; --silent plays without");
  player->server_ = std::move(*server);
  PulsePlayer* self = player.get();
  PulseOutputOptions stream;
  stream.rate_hz = player->source_->rate_hz();
  auto output = PulseOutput::open(*player->server_, stream, [self](MonoTime at, double frame) {
    self->clock_.report(at + self->options_.trim, frame);
  });
  if (!output) return fail(output.error().what + "; --silent plays without");
  player->output_ = std::move(*output);
  return player;
}

PulsePlayer::PulsePlayer(std::unique_ptr<MusicSource> source, const PulsePlayerOptions& options)
    : source_(std::move(source)),
      options_(options),
      clock_(source_->rate_hz()),
      plan_(source_->rate_hz()),
      block_(2 * kBlock_frames),
      gain_(options.volume, source_->rate_hz()) {}

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
  if (begin_ && plan_.is_aligned()) source_->prepare(plan_.song_frame(output_->written_frames()));
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
    if (begin_ && plan_.is_aligned()) {
      const std::int64_t frame = plan_.song_frame(output_->written_frames());
      if (auto read = source_->read(frame, stereo); !read) return read;
      gain_.apply(stereo);
    } else {
      std::fill(stereo.begin(), stereo.end(), 0.0f);
    }
    const std::int64_t before = output_->written_frames();
    output_->write(stereo);
    if (output_->written_frames() == before) break;  // refused: tried again in the next turn
    wanted -= frames;
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
