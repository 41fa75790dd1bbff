// A build without voices cannot decode them.
#include "viewer/replay/sound/recorded_voices.h"

namespace dance {

Result<std::unique_ptr<RecordedVoices>> RecordedVoices::create() {
  return fail("this build has no voices");
}

}  // namespace dance
