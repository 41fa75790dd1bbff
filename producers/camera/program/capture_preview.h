// The preview that --preview and --preview-file ask for.
//
// Ownership: plain function.
// Threads:   as producers/camera/view/preview.h.
// Failure:   an Error tells why there can be none; null where none was asked for.
#pragma once

#include <memory>
#include <string>

#include "producers/camera/program/capture_options.h"
#include "producers/camera/view/preview.h"

namespace dance {

enum class PreviewSide { kAsTheCameraSees, kAsTheStageShows };  // which may be a mirror

Result<std::unique_ptr<Preview>> open_preview(const CaptureOptions& options, PreviewSide side,
                                              const std::string& title);

}  // namespace dance
