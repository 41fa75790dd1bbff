#include "transformers/predict/model/predict_model.h"

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

// "DPPD" as bytes.
constexpr ModelFileKind kPredictModelFile{0x44505044, 2, "prediction", "dance predict train"};
constexpr float kMostNumber = 1e6f;
constexpr float kSameBone_m = 0.004f;

// Visits every number that is kept as a float, in the order of the file.
template <class Model, class Visit>
void visit_floats(Model& model, Visit visit) {
  for (auto& q : model.centres)
    for (auto& x : q.coeffs()) visit(x);
  for (auto& x : model.lever) visit(x);
  for (auto& x : model.horizon_scale) visit(x);
  for (auto& by_length : model.weights)
    for (auto& by_tremble : by_length)
      for (auto& by_kind : by_tremble)
        for (auto& by_horizon : by_kind)
          for (auto& predictions : by_horizon)
            for (auto& x : predictions) visit(x);
  for (auto& x : model.tremble_rad) visit(x);
}

std::uint32_t name_of_file(std::span<const std::uint8_t> file) { return folded(fnv1a(file)); }

void write_block(ByteWriter& out, const BodyNet::Numbers& block) {
  float most = 1e-12f;
  for (const float x : block) most = std::max(most, std::abs(x));
  const float step = most / 32767.0f;
  out.u32(std::bit_cast<std::uint32_t>(step));
  for (const float x : block)
    out.u16(static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(x / step))));
}

void read_block(ByteReader& in, BodyNet::Numbers& block) {
  const auto step = std::bit_cast<float>(in.u32());
  for (float& x : block) x = static_cast<float>(in.i16()) * step;
}

}  // namespace

BoneLengths bone_lengths(const Skeleton& skeleton) {
  BoneLengths lengths{};
  for (std::size_t b = 0; b < kBoneCount; ++b) lengths[b] = skeleton.offset_m[b].norm();
  return lengths;
}

bool is_alike(const BoneLengths& a, const BoneLengths& b, float most_m) {
  for (std::size_t i = 0; i < kBoneCount; ++i)
    if (!(std::abs(a[i] - b[i]) <= most_m)) return false;
  return true;
}

bool PredictModel::knows(const Skeleton& skeleton) const {
  const BoneLengths lengths = bone_lengths(skeleton);
  return std::any_of(dancers.begin(), dancers.end(), [&](const BoneLengths& known) {
    return is_alike(known, lengths, kSameBone_m);
  });
}

std::vector<std::uint8_t> write_predict_model(const PredictModel& model) {
  std::vector<std::uint8_t> file(sizeof(PredictModel) + (std::size_t{1} << 23));
  ByteWriter out(file);
  out.u32(kPredictModelFile.magic);
  out.u16(kPredictModelFile.version);
  out.u16(static_cast<std::uint16_t>(model.dancers.size()));
  const auto put = [&](float x) { out.u32(std::bit_cast<std::uint32_t>(x)); };
  visit_floats(model, put);
  for (const BoneLengths& lengths : model.dancers)
    for (const float x : lengths) put(x);
  // Small numbers that decide by their size are kept whole.
  for (const float x : model.net.mean) put(x);
  for (const float x : model.net.scale) put(x);
  BodyNet::visit(model.net, [&](const BodyNet::Numbers& block) {
    if (&block != &model.net.mean && &block != &model.net.scale) write_block(out, block);
  });
  DANCE_ASSERT(out.ok());
  file.resize(out.size());
  return file;
}

Result<std::shared_ptr<const PredictModel>> read_predict_model(std::span<const std::uint8_t> file) {
  auto model = std::make_shared<PredictModel>();
  ByteReader in(file);
  if (auto head = kPredictModelFile.read_head(in); !head) return tl::make_unexpected(head.error());
  const std::size_t dancers = in.u16();
  const auto get = [&](float& x) { x = std::bit_cast<float>(in.u32()); };
  bool is_whole = dancers <= kMostKnownDancers;
  if (is_whole) {
    visit_floats(*model, get);
    model->dancers.resize(dancers);
    for (BoneLengths& lengths : model->dancers)
      for (float& x : lengths) get(x);
    BodyNet& net = model->net;
    for (float& x : net.mean) get(x);
    for (float& x : net.scale) get(x);
    BodyNet::visit(net, [&](BodyNet::Numbers& block) {
      if (&block != &net.mean && &block != &net.scale) read_block(in, block);
    });
    is_whole = in.is_exhausted();
  }
  // The comparison refuses NaN too.
  const auto look = [&](const float& x) { is_whole = is_whole && std::abs(x) <= kMostNumber; };
  visit_floats(*model, look);
  for (const BoneLengths& lengths : model->dancers)
    for (const float& x : lengths) look(x);
  BodyNet::visit(model->net, [&](const BodyNet::Numbers& block) {
    for (const float& x : block) look(x);
  });
  for (const auto& q : model->centres)
    is_whole = is_whole && std::abs(q.squaredNorm() - 1.0f) < 0.02f;
  for (const float x : model->horizon_scale) is_whole = is_whole && x >= 1e-4f;
  is_whole =
      is_whole && model->tremble_rad[0] >= 0.0f && model->tremble_rad[1] > model->tremble_rad[0];
  if (!is_whole) return kPredictModelFile.damaged(file.size());
  for (auto& q : model->centres) q.normalize();
  model->name = name_of_file(file);
  return std::shared_ptr<const PredictModel>(std::move(model));
}

std::span<const std::uint8_t> predict_model_file();  // data/, by dance_embed

std::shared_ptr<const PredictModel> built_in_predict_model() {
  static const auto kModel = read_predict_model(predict_model_file());
  DANCE_ASSERT(kModel.has_value());  // a test reads it too
  return *kModel;
}

}  // namespace dance
