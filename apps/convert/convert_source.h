// What `dance convert` reads: a file of any kind as a recording.
//
// Units/frames: as formats/recording/recording_sink.h; clips begin when their file was last
//               changed.
// Ownership:    a source owns its file.
// Threads:      none inside; one owner.
// Failure:      an Error names the file and the cure; what was damaged is left out, and lost() says
//               what.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/bus/channel.h"
#include "formats/clip/file_kind.h"
#include "formats/recording/recording_sink.h"

namespace dance {

class ConvertSource {
 public:
  virtual ~ConvertSource() = default;
  virtual Result<void> read_into(RecordingSink& sink) = 0;
  // Where its dancers were heard.
  virtual Where where() const { return Where::kCapture; }
  // Assumptions and oddities, one line each.
  virtual std::vector<std::string> notes() const { return {}; }
  // What could not be read; "" where that is nothing.
  virtual std::string lost() const { return ""; }
};

// `guest` names the dancer of a file with one whose format has no guest ids; `where` chooses among
// the poses of an LCM log.
Result<std::unique_ptr<ConvertSource>> open_source(const std::string& path, const GuestId& guest,
                                                   std::optional<Where> where);

}  // namespace dance
