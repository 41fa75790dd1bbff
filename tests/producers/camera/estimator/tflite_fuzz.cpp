// A network as anybody may write it: what is taken has shapes that follow from each other and
// weights that fit.
#include <cmath>
#include <cstdint>

#include "core/base/assert.h"
#include "producers/camera/estimator/tflite_file.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(tflite_file) {
  auto graph = dance::parse_tflite({data, size});
  if (!graph) {
    DANCE_ASSERT(!graph.error().what.empty());
    return 0;
  }
  dance::fold_pads(*graph);
  std::vector<bool> is_made(graph->tensors.size(), false);
  is_made[static_cast<std::size_t>(graph->input)] = true;
  for (const dance::GraphNode& node : graph->nodes) {
    for (const int t : node.inputs) DANCE_ASSERT(is_made[static_cast<std::size_t>(t)]);
    for (const int t : {node.weights, node.bias}) {
      if (t < 0) continue;
      DANCE_ASSERT(graph->values(t).size() == dance::elements_of(graph->shape(t)));
      for (const float value : graph->values(t)) DANCE_ASSERT(std::isfinite(value));
    }
    is_made[static_cast<std::size_t>(node.output)] = true;
  }
  for (const int t : graph->outputs) DANCE_ASSERT(is_made[static_cast<std::size_t>(t)]);
  return 0;
}
