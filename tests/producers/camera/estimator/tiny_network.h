// Networks of every operation that the networks of body, hands and face have, of a few hundred
// numbers, as .tflite files and computed by plain loops.
//
// Units/frames: as producers/camera/estimator/pose_graph.h says.
// Ownership:    values.
// Threads:      none inside.
// Failure:      none; the numbers are the same each time.
#pragma once

#include <tflite_generated.h>

#include <cstdint>
#include <vector>

#include "producers/camera/estimator/pose_graph.h"

namespace dance {

struct TinyOptions {
  tflite::Options kind = tflite::Options::NONE;
  flatbuffers::Offset<void> table;
};

class TinyFile {
 public:
  TinyFile() { buffers_.push_back(tflite::CreateBuffer(builder_)); }
  // Returns the tensor's number.
  int computed(const std::vector<int>& shape);
  int floats(const std::vector<int>& shape, const std::vector<float>& values);
  int halves(const std::vector<int>& shape, const std::vector<std::uint16_t>& bits);
  int sparse_halves(const std::vector<int>& shape, const std::vector<std::uint16_t>& bits);
  int integers(const std::vector<int>& shape, const std::vector<int>& values);
  void add(int builtin, const std::vector<int>& inputs, int output, TinyOptions options = {});
  TinyOptions convolution(int padding, int stride, int activation);
  template <class Table>
  TinyOptions options(flatbuffers::Offset<Table> table) {
    return {tflite::OptionsTraits<Table>::enum_value, table.Union()};
  }
  flatbuffers::FlatBufferBuilder& builder() { return builder_; }
  // Once.
  std::vector<std::uint8_t> file(int input, const std::vector<int>& outputs);

 private:
  template <class T>
  int constant(const std::vector<int>& shape, int type, const std::vector<T>& values,
               flatbuffers::Offset<tflite::Sparsity> sparsity = {});
  int add_tensor(const std::vector<int>& shape, int type, std::size_t buffer,
                 flatbuffers::Offset<tflite::Sparsity> sparsity = {});

  flatbuffers::FlatBufferBuilder builder_;
  std::vector<flatbuffers::Offset<tflite::Tensor>> tensors_;
  std::vector<flatbuffers::Offset<tflite::Operator>> operators_;
  std::vector<flatbuffers::Offset<tflite::OperatorCode>> codes_;
  std::vector<flatbuffers::Offset<tflite::Buffer>> buffers_;
};

// Input 8×8×4; outputs 1×24 (joined) and 4×4×6.
std::vector<std::uint8_t> tiny_network_file();
// Input 8×8×4; output 1×5: what hands and face have beside that.
std::vector<std::uint8_t> tiny_hand_network_file();
// One convolution.
std::vector<std::uint8_t> tiny_convolution_file();

// Every output of the graph, by definition of the operations.
std::vector<std::vector<float>> computed_plainly(const PoseGraph& graph,
                                                 const std::vector<float>& input);

}  // namespace dance
