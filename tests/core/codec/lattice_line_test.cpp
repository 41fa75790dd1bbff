#include <gtest/gtest.h>

#include <deque>
#include <vector>

#include "tests/core/codec/lattice_ends.h"

namespace dance {
namespace {

// A line that loses, doubles and reorders; acknowledgements and requests lose as well.
void run_lossy_line(References policy, std::uint32_t frames, double least_decoded) {
  Ends ends;
  ends.encoder.set_references(policy);
  Random random(31), fate(37);
  struct Flight {
    std::uint32_t at;
    std::uint32_t sequence;
    std::vector<std::uint8_t> bytes;
  };
  std::deque<Flight> line;
  std::deque<std::pair<std::uint32_t, std::uint32_t>> acks;  // when, which
  std::uint32_t ask_at = 0, asked_until = 0;
  std::size_t received = 0, decoded = 0, wrong = 0;
  const auto receive = [&](const Flight& f, std::uint32_t now) {
    ++received;
    const DecodeResult result = ends.decoder.decode(f.sequence, f.bytes, ends.got);
    ASSERT_NE(result, DecodeResult::kMalformed);
    if (result == DecodeResult::kPose) {
      ++decoded;
      const CodedFrame* sent = ends.encoder.newest();
      if (sent != nullptr && sent->sequence == f.sequence)
        wrong += sent->body.x != ends.decoder.find(f.sequence)->body.x ? 1 : 0;
      if (fate.uniform() > 0.05) acks.emplace_back(now + 2, f.sequence);
    } else if (now >= asked_until) {
      ask_at = now + 2;
      asked_until = now + 5;
    }
  };
  for (std::uint32_t i = 0; i < frames; ++i) {
    for (; !acks.empty() && acks.front().first <= i; acks.pop_front())
      ends.encoder.acknowledged(acks.front().second);
    if (ask_at == i && i > 0) ends.encoder.request_intra();
    const Pose pose = dance_frame(i, random);
    ASSERT_GT(ends.encode(pose), 0u);
    Flight flight{
        i, i, {ends.payload.begin(), ends.payload.begin() + static_cast<long>(ends.size)}};
    const bool burst = i % 500 > 490;
    if (fate.uniform() > (burst ? 0.9 : 0.05)) {
      if (fate.uniform() < 0.02) flight.at += 3;  // overtaken
      line.push_back(flight);
      if (fate.uniform() < 0.02) line.push_back(flight);
    }
    for (auto it = line.begin(); it != line.end();)
      if (it->at <= i) {
        receive(*it, i);
        it = line.erase(it);
      } else {
        ++it;
      }
  }
  EXPECT_EQ(wrong, 0u) << "both ends hold the same";
  EXPECT_GE(static_cast<double>(decoded), least_decoded * static_cast<double>(received));
}

TEST(LatticeLine, AcknowledgedReferencesDecodeWhateverWasLost) {
  run_lossy_line(References::kAcknowledged, 20'000, 1.0);
}
TEST(LatticeLine, ChainsHealAfterLosses) {
  run_lossy_line(References::kPreviousTwice, 10'000, 0.9);
  run_lossy_line(References::kPrevious, 10'000, 0.6);
}

// A million frames over a bad line: hours of dance, and both ends still hold the same. Takes half a
// minute: codec_test --gtest_also_run_disabled_tests --gtest_filter=*AMillion*
TEST(LatticeLine, DISABLED_AMillionFramesLeaveNoDrift) {
  run_lossy_line(References::kAcknowledged, 1'000'000, 1.0);
}

}  // namespace
}  // namespace dance
