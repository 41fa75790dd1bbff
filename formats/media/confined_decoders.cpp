#include "formats/media/confined_decoders.h"

#include <utility>

#include "core/program/confinement.h"

namespace dance {
namespace {

// A decoder that is made, used and destroyed on its own confined thread.
template <class Decoder>
class Confined {
 public:
  ~Confined() {
    static_cast<void>(thread_.call([this] {
      decoder_.reset();
      return Result<void>();
    }));
  }
  Result<void> open(const std::function<Result<std::unique_ptr<Decoder>>()>& open) {
    return thread_.call([&]() -> Result<void> {
      DANCE_TRY(decoder_, open());
      return {};
    });
  }
  template <class Function>
  auto call(Function function) {
    return thread_.call([&] { return function(*decoder_); });
  }
  // Direct access, for values that the decoder keeps in memory.
  const Decoder& decoder() const { return *decoder_; }

 private:
  std::unique_ptr<Decoder> decoder_;
  ConfinedThread thread_;
};

class ConfinedAudio final : public AudioDecoder {
 public:
  AudioFormat format() const override { return confined_.decoder().format(); }
  Result<std::size_t> read(std::span<float> interleaved) override {
    return confined_.call([&](AudioDecoder& decoder) { return decoder.read(interleaved); });
  }
  Result<void> seek(std::int64_t frame) override {
    return confined_.call([&](AudioDecoder& decoder) { return decoder.seek(frame); });
  }
  AudioTags tags() const override { return confined_.decoder().tags(); }

  Confined<AudioDecoder> confined_;
};

class ConfinedVideo final : public VideoDecoder {
 public:
  const VideoFacts& facts() const override { return confined_.decoder().facts(); }
  std::optional<double> time_s() const override { return confined_.decoder().time_s(); }
  VideoSize size() const override { return confined_.decoder().size(); }
  bool step() override {
    return confined_.call([](VideoDecoder& decoder) { return Result<bool>(decoder.step()); })
        .value_or(false);
  }
  bool read(std::span<std::uint8_t> bgr) override {
    return confined_.call([&](VideoDecoder& decoder) { return Result<bool>(decoder.read(bgr)); })
        .value_or(false);
  }

  Confined<VideoDecoder> confined_;
};

}  // namespace

Result<std::unique_ptr<AudioDecoder>> open_confined(
    std::function<Result<std::unique_ptr<AudioDecoder>>()> open) {
  auto audio = std::make_unique<ConfinedAudio>();
  if (auto opened = audio->confined_.open(open); !opened)
    return tl::make_unexpected(std::move(opened.error()));
  return audio;
}

Result<std::unique_ptr<VideoDecoder>> open_confined(
    std::function<Result<std::unique_ptr<VideoDecoder>>()> open) {
  auto video = std::make_unique<ConfinedVideo>();
  if (auto opened = video->confined_.open(open); !opened)
    return tl::make_unexpected(std::move(opened.error()));
  return video;
}

}  // namespace dance
