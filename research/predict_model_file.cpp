#include "research/predict_model_file.h"

#include "formats/bvh/clip_file.h"

namespace dance {
namespace {

constexpr std::size_t kMostModelBytes = 1 << 24;

}  // namespace

Result<std::shared_ptr<const PredictModel>> read_predict_model_file(const std::string& path) {
  DANCE_TRY(const std::string file, read_clip_text(path, kMostModelBytes));
  auto model =
      read_predict_model({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
  if (!model) return fail(path + ": " + model.error().what);
  return *model;
}

Result<FlowParts> parts_with_model(const std::string& path) {
  FlowParts parts;
  if (path.empty()) return parts;
  DANCE_TRY(parts.predict_model, read_predict_model_file(path));
  return parts;
}

}  // namespace dance
