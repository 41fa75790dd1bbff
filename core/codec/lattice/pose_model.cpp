#include "core/codec/lattice/pose_model.h"

#include <bit>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"
#include "core/base/fnv1a.h"
#include "core/base/model_file.h"
#include "core/codec/exact/exact_math.h"

namespace dance {
namespace {

// "DCPM" as bytes.
constexpr ModelFileKind kPoseModelFile{0x4d504344, 1, "the pose codec", "dance codec train"};

// Visits every number of a model in the order of the file.
template <class Model, class OnHalf, class OnWord, class OnByte>
void visit(Model& model, OnHalf half, OnWord word, OnByte byte) {
  for (auto& bone : model.rest.bones) {
    for (auto& x : bone.centre_xyzw) half(x);
    for (auto& x : bone.hinge) half(x);
  }
  for (auto& x : model.table) word(x);
  for (auto& x : model.intra_table) word(x);
  for (auto& coordinate : model.intra) {
    for (auto& x : coordinate.from) byte(x);
    for (auto& x : coordinate.weight) half(x);
    half(coordinate.base);
    half(coordinate.spread_log2);
  }
  for (auto& coordinates : model.coordinates)
    for (auto& coordinate : coordinates) {
      for (auto& speed : coordinate.mean)
        for (auto& x : speed) half(x);
      for (auto& x : coordinate.spread) half(x);
    }
}

std::uint32_t name_of(std::span<const std::uint8_t> file) {
  const std::uint32_t name = folded(fnv1a(file));
  return name == 0 ? 1 : name;  // 0 is the generic model
}

bool is_distribution(const DistributionTable& table) {
  if (table[0] != 0 || table.back() > kTableTop / 2 * 256) return false;
  for (std::size_t i = 1; i < table.size(); ++i)
    if (table[i] < table[i - 1]) return false;
  return true;
}

}  // namespace

std::uint16_t to_half(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000);
  const float size = std::abs(value);
  if (!(size < 65504.0f)) return static_cast<std::uint16_t>(sign | 0x7bff);
  if (size < 6.1035156e-5f)
    return static_cast<std::uint16_t>(sign | std::lround(size * 16777216.0f));
  // Halfway cases round up; a mantissa that overflows carries into the exponent.
  const std::uint32_t rounded = (bits & 0x7fff'ffff) + 0x1000;
  return static_cast<std::uint16_t>(sign | ((rounded >> 13) - (112u << 10)));
}

float from_half(std::uint16_t half) {
  const std::uint32_t exponent = half >> 10 & 31u;
  const std::uint32_t mantissa = half & 1023u;
  float size = static_cast<float>(mantissa) / 16777216.0f;
  if (exponent > 0) size = std::bit_cast<float>((exponent + 112u) << 23 | mantissa << 13);
  return (half & 0x8000u) != 0 ? -size : size;
}

std::vector<std::uint8_t> write_model(const PoseModel& model) {
  std::vector<std::uint8_t> file(sizeof(PoseModel));
  ByteWriter out(file);
  out.u32(kPoseModelFile.magic);
  out.u16(kPoseModelFile.version);
  visit(
      model, [&](float x) { out.u16(to_half(x)); }, [&](std::uint32_t x) { out.u32(x); },
      [&](std::uint8_t x) { out.u8(x); });
  DANCE_ASSERT(out.ok());
  file.resize(out.size());
  return file;
}

Result<std::shared_ptr<const PoseModel>> read_model(std::span<const std::uint8_t> file) {
  auto model = std::make_shared<PoseModel>();
  ByteReader in(file);
  if (auto head = kPoseModelFile.read_head(in); !head) return tl::make_unexpected(head.error());
  visit(
      *model, [&](float& x) { x = from_half(in.u16()); }, [&](std::uint32_t& x) { x = in.u32(); },
      [&](std::uint8_t& x) { x = in.u8(); });
  bool is_whole =
      in.is_exhausted() && is_distribution(model->table) && is_distribution(model->intra_table);
  for (std::size_t c = 0; c < kCoordinateCount && is_whole; ++c)
    for (std::size_t i = 0; i < kIntraTerms; ++i) {
      // Only coordinates decoded before; the first has none.
      const auto [from, weight] = std::pair{model->intra[c].from[i], model->intra[c].weight[i]};
      is_whole = is_whole && (c == 0 ? from == 0 && weight == 0.0f : from < c);
    }
  bool is_finite = true;
  visit(
      *model, [&](float x) { is_finite = is_finite && std::isfinite(x); }, [](std::uint32_t) {},
      [](std::uint8_t) {});
  for (const auto& bone : model->rest.bones) {
    const auto& q = bone.centre_xyzw;
    const float n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    is_finite = is_finite && n > 0.5f && n < 2.0f;
  }
  if (!is_whole || !is_finite) return kPoseModelFile.damaged(file.size());
  model->name = name_of(file);
  return std::shared_ptr<const PoseModel>(std::move(model));
}

DistributionTable logistic_table(double wide_share) {
  const auto logistic = [](double z) { return 1.0 / (1.0 + exact::exp2(-z * 1.4426950408889634)); };
  DistributionTable table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double z = static_cast<double>(i) / 16.0;
    const double F = (1.0 - wide_share) * logistic(z) + wide_share * logistic(z / 3.0) - 0.5;
    table[i] = static_cast<std::uint32_t>(F * 256.0 * kTableTop);
  }
  return table;
}

// Damped velocity of 0.8, a third of it from the end's motion in the room.
std::shared_ptr<const PoseModel> generic_model() {
  static const std::shared_ptr<const PoseModel> kModel = [] {
    auto model = std::make_shared<PoseModel>();
    model->table = logistic_table(0.15);
    model->intra_table = logistic_table(0.0);
    for (std::size_t c = 0; c < kCoordinateCount; ++c)
      model->intra[c].spread_log2 = c == 0 || c == 2 ? 0.0f : c == 1 ? -4.0f : -2.0f;
    for (std::size_t slow = 0; slow < 2; ++slow)
      for (const std::uint8_t age : kModelAges)
        for (const std::uint8_t run : kModelRuns)
          for (CoordinateModel& coordinate : model->coordinates[case_index(slow != 0, age, run)]) {
            const float ahead = static_cast<float>(age) * 0.6f;
            for (auto& mean : coordinate.mean) {
              mean[1] = 0.65f * ahead;
              mean[4] = 0.35f;
              mean[5] = 0.35f * ahead;
            }
            coordinate.spread[0] = run > 1 ? 0.3f : 0.8f;
            coordinate.spread[2] = 0.3f;
            coordinate.spread[5] = 0.2f;
            coordinate.spread[6] = 0.25f;
            coordinate.spread[8] = 0.2f;
            coordinate.spread[9] = 0.4f;
          }
    return model;
  }();
  return kModel;
}

std::span<const std::uint8_t> body_model_file();  // data/, by dance_embed

std::shared_ptr<const PoseModel> built_in_model() {
  static const auto kModel = read_model(body_model_file());
  DANCE_ASSERT(kModel.has_value());  // a test reads it too
  return *kModel;
}

}  // namespace dance
