#include "research/trackers/tracker_model_file.h"

#include "core/program/whole_file.h"

namespace dance {
namespace {

constexpr std::size_t kMostTrackerFileBytes = 1 << 20;

}  // namespace

Result<std::shared_ptr<const TrackerModel>> read_tracker_model_file(const std::string& path) {
  auto file = read_whole_file(path, kMostTrackerFileBytes);
  if (!file) return fail(file.error().what + "; make a model with dance trackers train");
  auto model =
      read_tracker_model({reinterpret_cast<const std::uint8_t*>(file->data()), file->size()});
  if (!model) return fail(path + ": " + model.error().what);
  return *model;
}

Result<void> write_tracker_model_file(const TrackerModel& model, const std::string& path) {
  const std::vector<std::uint8_t> bytes = write_tracker_model(model);
  if (!read_tracker_model(bytes))
    return fail(path + " is left as it was: what was learnt has numbers that no solver could use");
  return write_whole_file(path, bytes);
}

}  // namespace dance
