#include "producers/camera/estimator/pose_engine.h"

namespace dance {

EngineKind chosen_engine(EngineKind wished) {
  if (wished != EngineKind::kFastest) return wished;
  return kHasXnnpack ? EngineKind::kXnnpack : EngineKind::kOpenCv;
}

std::string_view name_of(EngineKind kind) {
  return chosen_engine(kind) == EngineKind::kXnnpack ? "xnnpack" : "opencv";
}

Result<std::unique_ptr<PoseEngine>> make_engine(EngineKind kind, const PoseGraph& graph) {
  if (chosen_engine(kind) == EngineKind::kOpenCv) return make_opencv_engine(graph);
#ifdef DANCE_HAVE_XNNPACK
  return make_xnnpack_engine(graph);
#else
  return fail(
      "the engine xnnpack is not built in: install libxnnpack-dev and libpthreadpool-dev, and "
      "build again, "
      "or take the engine opencv");
#endif
}

}  // namespace dance
