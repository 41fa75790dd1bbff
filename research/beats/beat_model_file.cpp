#include "research/beats/beat_model_file.h"

#include "core/program/whole_file.h"

namespace dance {
namespace {

constexpr std::size_t kMostModelFileBytes = 1 << 20;

}  // namespace

Result<std::shared_ptr<const BeatModel>> read_beat_model_file(const std::string& path) {
  auto file = read_whole_file(path, kMostModelFileBytes);
  if (!file) return fail(file.error().what + "; make a model with dance music train");
  auto model = read_beat_model({reinterpret_cast<const std::uint8_t*>(file->data()), file->size()});
  if (!model) return fail(path + ": " + model.error().what);
  return *model;
}

Result<void> write_beat_model_file(const BeatModel& model, const std::string& path) {
  const std::vector<std::uint8_t> bytes = write_beat_model(model);
  if (!read_beat_model(bytes))
    return fail(path +
                " is left as it was: what was learnt has numbers that no tracker could use; look "
                "at the songs' beats");
  return write_whole_file(path, bytes);
}

}  // namespace dance
