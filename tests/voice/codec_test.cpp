#include <gtest/gtest.h>

#include "core/base/random.h"
#include "testing/voice/sound_match.h"
#include "tests/allocation_guard.h"
#include "tests/voice/voices.h"
#include "voice/codec/voice_decoder.h"
#include "voice/codec/voice_encoder.h"
#include "voice/codec/voice_packet.h"

namespace dance {
namespace {

using Packet = std::vector<std::uint8_t>;

std::vector<Packet> packets_of(const std::vector<float>& sound,
                               const VoiceEncoderOptions& options) {
  auto encoder = VoiceEncoder::create(options);
  EXPECT_TRUE(encoder) << encoder.error().what;
  std::vector<Packet> packets;
  for (std::size_t at = 0; at + kVoiceFrameSamples <= sound.size(); at += kVoiceFrameSamples) {
    const auto packet =
        (*encoder)->encode(std::span(sound).subspan(at).first<kVoiceFrameSamples>());
    packets.emplace_back(packet.begin(), packet.end());
  }
  return packets;
}

std::unique_ptr<VoiceDecoder> decoder() {
  auto made = VoiceDecoder::create();
  EXPECT_TRUE(made) << made.error().what;
  return std::move(*made);
}

TEST(VoiceCodec, WhatComesOutSoundsLikeWhatWentIn) {
  const auto sound = hummed(4.0, false);
  for (const VoiceMode mode : {VoiceMode::kSpeech, VoiceMode::kLowDelay}) {
    VoiceEncoderOptions options;
    options.mode = mode;
    auto made = VoiceEncoder::create(options);
    ASSERT_TRUE(made);
    const double look_ahead_ms = (*made)->look_ahead().as_ms();
    EXPECT_NEAR(look_ahead_ms, mode == VoiceMode::kSpeech ? 6.5 : 2.5, 0.1);
    auto to_sound = decoder();
    std::vector<float> decoded;
    std::size_t bytes = 0;
    for (const Packet& packet : packets_of(sound, options)) {
      VoiceFrame frame;
      EXPECT_TRUE(to_sound->decode(packet, frame));
      decoded.insert(decoded.end(), frame.begin(), frame.end());
      bytes += packet.size();
    }
    EXPECT_LT(bytes * 8 / 4, 40'000u) << "bits a second";
    const auto matches = match_sound(sound, decoded, 0.0, 30.0);
    const MatchFigures figures = figures_of(matches);
    EXPECT_GE(figures.fitting + 1, figures.pieces);
    EXPECT_NEAR(figures.median_ms, look_ahead_ms, 0.5);
    // The first begins from nothing, and the end of the last is not decoded.
    for (std::size_t i = 1; i + 1 < matches.size(); ++i) EXPECT_GT(matches[i].likeness, 0.8) << i;
  }
}

TEST(VoiceCodec, SilenceIsSaidAndThenLeftOut) {
  std::vector<float> sound = hummed(2.0, false);
  sound.resize(sound.size() + 48'000 * 5, 0.0f);
  const auto packets = packets_of(sound, {});
  std::size_t sent = 0, said = 0;
  for (std::size_t i = 300; i < packets.size(); ++i) {
    sent += packets[i].empty() ? 0 : 1;
    said += !packets[i].empty() && is_silence(packets[i]) ? 1 : 0;
  }
  EXPECT_GE(said, 8u) << "four seconds: those who come meanwhile learn of it";
  EXPECT_LE(sent, 30u) << "of 400";
}

TEST(VoiceCodec, ALostFrameComesFromTheCopyInTheNext) {
  const auto sound = hummed(6.0, false);
  const auto packets = packets_of(sound, {});
  auto whole = decoder(), with_copies = decoder(), without = decoder();
  double with_off = 0.0, without_off = 0.0;
  int copies = 0, lost = 0;
  for (std::size_t i = 0; i + 1 < packets.size(); ++i) {
    VoiceFrame reference, from_copy, made_up;
    ASSERT_TRUE(whole->decode(packets[i], reference));
    if (i < 50 || i % 20 != 0) {
      with_copies->decode(packets[i], from_copy);
      without->decode(packets[i], made_up);
      continue;
    }
    ++lost;
    copies += with_copies->decode_lost(packets[i + 1], from_copy) ? 1 : 0;
    without->conceal(made_up);
    for (std::size_t k = 0; k < reference.size(); ++k) {
      with_off += std::pow(static_cast<double>(from_copy[k] - reference[k]), 2);
      without_off += std::pow(static_cast<double>(made_up[k] - reference[k]), 2);
    }
  }
  EXPECT_GT(copies, lost / 2) << "most packets of speech have a copy";
  EXPECT_LT(with_off, without_off);
}

TEST(VoiceCodec, WhatIsNoFrameOfTenMillisecondsIsConcealedAndCounted) {
  auto to_sound = decoder();
  VoiceFrame frame;
  EXPECT_FALSE(to_sound->decode({}, frame));
  const Packet twenty_ms{0x48, 1, 2, 3, 4};       // SILK, 20 ms
  const Packet many_frames{0x43, 0x30, 1, 2, 3};  // 48 frames in one packet
  EXPECT_FALSE(to_sound->decode(twenty_ms, frame));
  EXPECT_FALSE(to_sound->decode(many_frames, frame));
  EXPECT_FALSE(to_sound->decode(Packet(kMaxVoiceBytes + 1, 0xff), frame));
  EXPECT_EQ(to_sound->bad_packets(), 4u);
  Random random(5);
  for (int i = 0; i < 3000; ++i) {
    Packet packet(1 + random.below(kMaxVoiceBytes));
    for (std::uint8_t& byte : packet) byte = static_cast<std::uint8_t>(random.next_u64());
    to_sound->decode(packet, frame);
    for (const float sample : frame) {
      ASSERT_TRUE(std::isfinite(sample));
      ASSERT_LE(std::abs(sample), VoiceDecoder::kLoudest);
    }
  }
}

TEST(VoiceCodec, AllocatesNothingOnceItIsMade) {
  const auto sound = hummed(1.0, false);
  auto encoder = VoiceEncoder::create({});
  ASSERT_TRUE(encoder);
  auto to_sound = decoder();
  VoiceFrame frame;
  const AllocationGuard guard;
  for (std::size_t at = 0; at + kVoiceFrameSamples <= sound.size(); at += kVoiceFrameSamples) {
    const auto packet =
        (*encoder)->encode(std::span(sound).subspan(at).first<kVoiceFrameSamples>());
    if (!packet.empty()) to_sound->decode(packet, frame);
    to_sound->conceal(frame);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
