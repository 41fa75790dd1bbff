// A network of every operation that the pose networks have, of a few hundred numbers, as a .tflite
// file and computed by plain loops.
//
// Units/frames: as producers/camera/estimator/pose_graph.h says.
// Ownership:    values.
// Threads:      none inside.
// Failure:      none; the numbers are the same each time.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "producers/camera/estimator/pose_graph.h"
#include "tests/producers/camera/estimator/flat_maker.h"

namespace dance {

class TinyFile {
 public:
  // Returns the tensor's number.
  int computed(const std::vector<int>& shape);
  int floats(const std::vector<int>& shape, const std::vector<float>& values);
  int halves(const std::vector<int>& shape, const std::vector<std::uint16_t>& bits);
  int sparse_halves(const std::vector<int>& shape, const std::vector<std::uint16_t>& bits);
  int integers(const std::vector<int>& shape, const std::vector<int>& values);
  void add(int builtin, const std::vector<int>& inputs, int output, Flat options = {});
  std::vector<std::uint8_t> file(int input, const std::vector<int>& outputs) const;

 private:
  int constant(const std::vector<int>& shape, int type, std::vector<std::uint8_t> raw);

  std::vector<Flat> tensors_, operators_, codes_, buffers_{Flat{}};
};

// Input 8×8×4; outputs 1×24 (joined) and 4×4×6.
std::vector<std::uint8_t> tiny_network_file();
// One convolution.
std::vector<std::uint8_t> tiny_convolution_file();

// Every output of the graph, by definition of the operations.
std::vector<std::vector<float>> computed_plainly(const PoseGraph& graph,
                                                 const std::vector<float>& input);

}  // namespace dance
