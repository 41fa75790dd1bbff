// The tensors of a .tflite file: shapes, and the numbers of those that are constants, whichever way
// the file keeps them.
//
// Units/frames: as producers/camera/estimator/pose_graph.h says.
// Ownership:    looks at the file's bytes; what it returns owns its numbers.
// Threads:      none inside.
// Failure:      an Error names the tensor and what is wrong with it. No tensor has more than 4 Mi
//               elements, all constants together not more than 16 Mi.
// Source:       the schema of TensorFlow Lite, version 3.
#pragma once

#include <tflite_generated.h>

#include <span>
#include <vector>

#include "core/base/result.h"
#include "producers/camera/estimator/pose_graph.h"

namespace dance {

class TfliteTensors {
 public:
  // Of tables that were verified.
  static Result<TfliteTensors> read(const tflite::Model& model, const tflite::Subgraph& subgraph);

  std::size_t count() const { return tensors_.size(); }
  bool has(int tensor) const {
    return tensor >= 0 && static_cast<std::size_t>(tensor) < tensors_.size();
  }
  const Shape& shape(int tensor) const { return at(tensor).shape; }
  std::string name(int tensor) const { return at(tensor).name; }
  bool is_constant(int tensor) const;
  // From here on `to` has the numbers of `from`: they differ in how the file keeps them.
  void set_same(int from, int to);

  Result<std::vector<float>> floats(int tensor);
  Result<std::vector<int>> integers(int tensor);

 private:
  struct Tensor {
    std::string name;
    Shape shape;
    int type = 0;
    std::span<const std::uint8_t> data;
    const tflite::Sparsity* sparsity = nullptr;
    int same_as = -1;
  };
  const Tensor& at(int tensor) const { return tensors_[static_cast<std::size_t>(tensor)]; }
  const Tensor& source_of(int tensor) const;
  Result<void> read_tensor(const tflite::Tensor& table, const tflite::Model& model);
  Result<std::vector<float>> stored_floats(const Tensor& tensor, std::size_t count) const;
  Result<std::vector<float>> dense(const Tensor& tensor) const;

  std::vector<Tensor> tensors_;
  std::size_t elements_read_ = 0;
};

}  // namespace dance
