#include "producers/trackers/net/tracker_model.h"

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

// "DGTR" as bytes.
constexpr ModelFileKind kTrackerModelFile{0x52544744, 1, "tracked bodies", "dance trackers train"};
constexpr float kMostTrackerWeight = 1e3f;
constexpr float kSteps = 32767.0f;
constexpr std::size_t kMostTrackerModelBytes = 1 << 20;

// Visits every column, in the order of the file.
template <class Net, class Visit>
void visit_columns(Net& net, const Visit& visit) {
  const auto all = [&](auto& matrix) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      visit(matrix.data() + j * matrix.rows(), matrix.rows());
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

void write_sizes(ByteWriter& out) {
  out.u16(static_cast<std::uint16_t>(TrackerRow::kInputs));
  out.u16(static_cast<std::uint16_t>(TrackerRow::kOutputs));
  out.u16(static_cast<std::uint16_t>(TrackerNet::kUnits));
  out.u16(static_cast<std::uint16_t>(TrackerNet::kLayers));
}

bool are_our_sizes(ByteReader& in) {
  const std::size_t inputs = in.u16(), outputs = in.u16(), units = in.u16(), layers = in.u16();
  return inputs == TrackerRow::kInputs && outputs == TrackerRow::kOutputs &&
         units == static_cast<std::size_t>(TrackerNet::kUnits) &&
         layers == static_cast<std::size_t>(TrackerNet::kLayers);
}

}  // namespace

std::vector<std::uint8_t> write_tracker_model(const TrackerModel& model) {
  std::vector<std::uint8_t> file(kMostTrackerModelBytes);
  ByteWriter out(file);
  out.u32(kTrackerModelFile.magic);
  out.u16(kTrackerModelFile.version);
  write_sizes(out);
  visit_columns(model.net, [&](const float* column, Eigen::Index rows) {
    float most = 0.0f;
    for (Eigen::Index i = 0; i < rows; ++i) most = std::max(most, std::abs(column[i]));
    DANCE_ASSERT(most <= kMostTrackerWeight);
    const float scale = most / kSteps;
    out.u32(std::bit_cast<std::uint32_t>(scale));
    for (Eigen::Index i = 0; i < rows; ++i)
      out.u16(static_cast<std::uint16_t>(static_cast<std::int16_t>(
          scale > 0.0f ? std::lround(std::clamp(column[i] / scale, -kSteps, kSteps)) : 0)));
  });
  DANCE_ASSERT(out.ok());
  file.resize(out.size());
  return file;
}

Result<std::shared_ptr<const TrackerModel>> read_tracker_model(std::span<const std::uint8_t> file) {
  ByteReader in(file);
  if (auto head = kTrackerModelFile.read_head(in); !head) return tl::make_unexpected(head.error());
  auto model = std::make_shared<TrackerModel>();
  bool is_whole = are_our_sizes(in);
  if (is_whole) {
    visit_columns(model->net, [&](float* column, Eigen::Index rows) {
      const float scale = std::bit_cast<float>(in.u32());
      is_whole = is_whole && scale >= 0.0f && scale <= kMostTrackerWeight / kSteps;  // NaN too
      for (Eigen::Index i = 0; i < rows; ++i) {
        const float x = scale * static_cast<float>(in.i16());
        column[i] = is_whole ? x : 0.0f;
      }
    });
    is_whole = is_whole && in.is_exhausted();
  }
  if (!is_whole) return kTrackerModelFile.damaged(file.size());
  model->name = folded(fnv1a(file));
  return std::shared_ptr<const TrackerModel>(std::move(model));
}

std::span<const std::uint8_t> tracker_model_file();  // data/, by dance_embed

std::shared_ptr<const TrackerModel> built_in_tracker_model() {
  static const auto kModel = read_tracker_model(tracker_model_file());
  DANCE_ASSERT(kModel.has_value());  // a test reads it too
  return *kModel;
}

}  // namespace dance
