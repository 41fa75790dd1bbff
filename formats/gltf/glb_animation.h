// The tracks of one animation of a glTF file, to be asked for any moment of it.
//
// Units/frames: seconds of the file's own time; transforms as in glb_scene.h.
// Ownership:    copies the keys.
// Threads:      none inside; const use from any.
// Failure:      read_animation() names the channel or the accessor that is wrong.
// Source:       glTF 2.0, appendix C. Animation Sampler Interpolation Modes.
#pragma once

#include <string>
#include <vector>

#include "formats/gltf/glb_scene.h"

namespace dance {

enum class GlbPath : std::uint8_t { kTranslation, kRotation, kScale };

class GlbTrack {
 public:
  enum class Between : std::uint8_t { kStep, kLinear, kCubic };

  GlbTrack(int node, GlbPath path, Between between, std::vector<float> times_s,
           std::vector<float> values)
      : node_(node),
        path_(path),
        between_(between),
        times_s_(std::move(times_s)),
        values_(std::move(values)) {}

  int node() const { return node_; }
  GlbPath path() const { return path_; }
  const std::vector<float>& times_s() const { return times_s_; }
  // Before the first key and after the last their values hold.
  void apply(double time_s, GlbTransform& transform) const;

 private:
  Eigen::Vector4d key(std::size_t index, std::size_t part) const;
  Eigen::Vector4d value_at(double time_s) const;

  int node_;
  GlbPath path_;
  Between between_;
  std::vector<float> times_s_;
  std::vector<float> values_;
};

struct GlbAnimation {
  std::string name;
  std::vector<GlbTrack> tracks;
  double begin_s = 0.0;
};

// The moments of an animation at which a figure is looked at, in the file's own time.
struct GlbMoments {
  std::vector<double> times_s;
  double rate_hz = 0.0;
};
// The keys, where they are evenly spaced; else 60 moments a second from the animation's beginning
// to the last key of these tracks, but no more than `most`.
GlbMoments moments_of(const GlbAnimation& animation, const std::vector<const GlbTrack*>& tracks,
                      std::size_t most);

// `values_left` is how many numbers may be kept in memory yet, and is counted down.
Result<GlbAnimation> read_animation(const tinygltf::Model& model, std::size_t index,
                                    const GlbScene& scene, std::size_t& values_left);

}  // namespace dance
