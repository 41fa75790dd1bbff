#include "producers/music/tracker/beat_model.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"
#include "core/base/fnv1a.h"
#include "core/base/model_file.h"

namespace dance {
namespace {

// "DGBT" as bytes.
constexpr ModelFileKind kBeatModelFile{0x54424744, 3, "beats", "dance music train"};
constexpr float kMostWeight = 1e4f;
constexpr int kLeastPatternTempo_bpm = 40;
constexpr int kMostPatternTempo_bpm = 400;
// Each pattern covers some of the tempi that are searched.
constexpr int kSlowestOfUse_bpm = 75;
constexpr int kFastestOfUse_bpm = 200;
constexpr std::size_t kMostBeatModelBytes = 1 << 20;

// Visits every number that is kept as a float, in the order of the file.
template <class Net, class Visit>
void visit_net(Net& net, Visit visit) {
  const auto all = [&](auto& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) visit(matrix.data()[i]);
  };
  for (auto& layer : net.layers) {
    all(layer.in);
    all(layer.again);
    all(layer.in_bias);
    all(layer.again_bias);
  }
  all(net.out);
  all(net.out_bias);
}

std::uint32_t name_of(std::span<const std::uint8_t> file) { return folded(fnv1a(file)); }

}  // namespace

std::vector<std::uint8_t> write_beat_model(const BeatModel& model) {
  DANCE_ASSERT(!model.patterns.empty() && model.patterns.size() <= BeatModel::kMostPatterns);
  std::vector<std::uint8_t> file(kMostBeatModelBytes);
  ByteWriter out(file);
  out.u32(kBeatModelFile.magic);
  out.u16(kBeatModelFile.version);
  out.u16(static_cast<std::uint16_t>(model.patterns.size()));
  const auto put = [&](const float& x) { out.u32(std::bit_cast<std::uint32_t>(x)); };
  visit_net(model.net, put);
  for (const MeterPattern& pattern : model.patterns) {
    out.u16(static_cast<std::uint16_t>(pattern.least_tempo_bpm));
    out.u16(static_cast<std::uint16_t>(pattern.most_tempo_bpm));
    for (const auto& row : pattern.weights)
      for (const std::uint8_t weight : row) out.u8(weight);
  }
  DANCE_ASSERT(out.ok());
  file.resize(out.size());
  return file;
}

Result<std::shared_ptr<const BeatModel>> read_beat_model(std::span<const std::uint8_t> file) {
  ByteReader in(file);
  if (auto head = kBeatModelFile.read_head(in); !head) return tl::make_unexpected(head.error());
  auto model = std::make_shared<BeatModel>();
  const std::size_t patterns = in.u16();
  bool is_whole = patterns > 0 && patterns <= BeatModel::kMostPatterns;
  if (is_whole) {
    const auto take = [&](float& x) {
      x = std::bit_cast<float>(in.u32());
      is_whole = is_whole && std::abs(x) <= kMostWeight;  // refuses NaN too
    };
    visit_net(model->net, take);
    model->patterns.resize(patterns);
    for (MeterPattern& pattern : model->patterns) {
      pattern.least_tempo_bpm = in.u16();
      pattern.most_tempo_bpm = in.u16();
      is_whole = is_whole && pattern.least_tempo_bpm >= kLeastPatternTempo_bpm &&
                 pattern.most_tempo_bpm <= kMostPatternTempo_bpm &&
                 pattern.least_tempo_bpm <= kFastestOfUse_bpm &&
                 pattern.most_tempo_bpm >= kSlowestOfUse_bpm &&
                 // Periods are whole hops: between narrower bounds there may be none.
                 pattern.most_tempo_bpm * 20 >= pattern.least_tempo_bpm * 21;
      for (auto& row : pattern.weights)
        for (std::uint8_t& weight : row) weight = in.u8();
    }
    is_whole = is_whole && in.is_exhausted();
  }
  if (!is_whole) return kBeatModelFile.damaged(file.size());
  model->name = name_of(file);
  return std::shared_ptr<const BeatModel>(std::move(model));
}

std::span<const std::uint8_t> beat_model_file();  // data/, by dance_embed

std::shared_ptr<const BeatModel> built_in_beat_model() {
  static const auto kModel = read_beat_model(beat_model_file());
  DANCE_ASSERT(kModel.has_value());  // a test reads it too
  return *kModel;
}

}  // namespace dance
