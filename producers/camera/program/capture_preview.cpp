#include "producers/camera/program/capture_preview.h"

namespace dance {

Result<std::unique_ptr<Preview>> open_preview(const CaptureOptions& options, PreviewSide side,
                                              const std::string& title) {
  if (!options.has_preview && options.preview_file.empty()) return nullptr;
  PreviewOptions preview;
  preview.window = options.has_preview;
  preview.file = options.preview_file;
  preview.is_mirrored = side == PreviewSide::kAsTheStageShows && options.is_mirrored;
  preview.title = title;
  return Preview::open(preview);
}

}  // namespace dance
