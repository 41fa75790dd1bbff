#include "formats/gltf/glb_animation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "formats/gltf/glb_accessor.h"
#include "formats/gltf/glb_text.h"

namespace dance {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector4d;

// Keys this near to an even grid, as a share of its step, are on it: times are floats.
constexpr double kEven = 0.1;
// A rate this near to a whole number of frames a second is that number, as a share of it.
constexpr double kWholeRate = 1e-3;
constexpr std::size_t kFewestKeys = 8;
constexpr double kSlowest_hz = 15.0;
constexpr double kFastest_hz = 1000.0;
constexpr double kUsualRate_hz = 60.0;  // where keys are sparse
constexpr double kLongest_s = 1e6;

std::size_t components_of(GlbPath path) { return path == GlbPath::kRotation ? 4 : 3; }

std::optional<GlbPath> path_named(const std::string& name) {
  if (name == "translation") return GlbPath::kTranslation;
  if (name == "rotation") return GlbPath::kRotation;
  if (name == "scale") return GlbPath::kScale;
  return std::nullopt;  // "weights" of faces, and pointers of extensions
}

Result<GlbTrack::Between> between_named(const std::string& name) {
  if (name == "LINEAR" || name.empty()) return GlbTrack::Between::kLinear;
  if (name == "STEP") return GlbTrack::Between::kStep;
  if (name == "CUBICSPLINE") return GlbTrack::Between::kCubic;
  return fail("an interpolation that glTF does not have");
}

Result<GlbTrack> read_track(const tinygltf::Model& model, int node, GlbPath path,
                            const tinygltf::AnimationSampler& sampler, std::size_t& values_left) {
  DANCE_TRY(const GlbTrack::Between between, between_named(sampler.interpolation));
  DANCE_TRY(std::vector<float> times_s, read_floats(model, sampler.input, 1, values_left));
  values_left -= times_s.size();
  if (std::adjacent_find(times_s.begin(), times_s.end(), std::greater_equal<>()) != times_s.end())
    return fail("accessor " + std::to_string(sampler.input) + ": its times do not increase");
  const std::size_t components = components_of(path);
  DANCE_TRY(std::vector<float> values, read_floats(model, sampler.output, components, values_left));
  values_left -= values.size();
  const std::size_t parts = between == GlbTrack::Between::kCubic ? 3 : 1;
  if (values.size() != times_s.size() * components * parts)
    return fail("accessor " + std::to_string(sampler.output) + " has not one value for each key");
  return GlbTrack(node, path, between, std::move(times_s), std::move(values));
}

// Frames a second of keys that are evenly spaced.
std::optional<double> even_rate(const std::vector<float>& times_s) {
  if (times_s.size() < kFewestKeys) return std::nullopt;
  const auto first = static_cast<double>(times_s.front());
  const double step =
      (static_cast<double>(times_s.back()) - first) / static_cast<double>(times_s.size() - 1);
  for (std::size_t i = 0; i < times_s.size(); ++i)
    if (std::abs(static_cast<double>(times_s[i]) - first - static_cast<double>(i) * step) >
        kEven * step)
      return std::nullopt;
  const double rate = 1.0 / step;
  const double whole = std::round(rate);
  if (rate > kFastest_hz || rate < kSlowest_hz) return std::nullopt;
  return std::abs(rate - whole) < kWholeRate * rate ? whole : rate;
}

}  // namespace

Vector4d GlbTrack::key(std::size_t index, std::size_t part) const {
  const std::size_t components = components_of(path_);
  const std::size_t parts = between_ == Between::kCubic ? 3 : 1;
  const float* at = values_.data() + (index * parts + part) * components;
  Vector4d value = Vector4d::Zero();
  for (std::size_t c = 0; c < components; ++c)
    value[static_cast<int>(c)] = static_cast<double>(at[c]);
  return value;
}

Vector4d GlbTrack::value_at(double time_s) const {
  const std::size_t middle = between_ == Between::kCubic ? 1 : 0;
  const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s,
                                      [](double t, float k) { return t < static_cast<double>(k); });
  if (after == times_s_.begin()) return key(0, middle);
  const auto before = static_cast<std::size_t>(after - times_s_.begin()) - 1;
  if (after == times_s_.end() || between_ == Between::kStep) return key(before, middle);
  const auto begin_s = static_cast<double>(times_s_[before]);
  const double step_s = static_cast<double>(*after) - begin_s;
  const double t = (time_s - begin_s) / step_s;
  const Vector4d a = key(before, middle);
  const Vector4d b = key(before + 1, middle);
  if (between_ == Between::kCubic) {
    // Hermite's: values, and tangents a second; of a key: in-tangent, value, out-tangent.
    const double t2 = t * t;
    const double t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * a + step_s * (t3 - 2 * t2 + t) * key(before, 2) +
           (3 * t2 - 2 * t3) * b + step_s * (t3 - t2) * key(before + 1, 0);
  }
  if (path_ != GlbPath::kRotation) return a + t * (b - a);
  Quaterniond from(a);
  Quaterniond to(b);
  return from.normalized().slerp(t, to.normalized()).coeffs();
}

void GlbTrack::apply(double time_s, GlbTransform& transform) const {
  const Vector4d value = value_at(time_s);
  switch (path_) {
    case GlbPath::kTranslation:
      transform.translation = value.head<3>();
      break;
    case GlbPath::kScale:
      transform.scale = value.head<3>();
      break;
    case GlbPath::kRotation:
      if (value.norm() > 1e-6) transform.rotation = Quaterniond(value).normalized();
      break;
  }
}

GlbMoments moments_of(const GlbAnimation& animation, const std::vector<const GlbTrack*>& tracks,
                      std::size_t most) {
  const auto fewer_keys = [](const GlbTrack* a, const GlbTrack* b) {
    return a->times_s().size() < b->times_s().size();
  };
  const GlbTrack& longest = **std::max_element(tracks.begin(), tracks.end(), fewer_keys);
  GlbMoments moments;
  double end_s = animation.begin_s;
  for (const GlbTrack* track : tracks)
    end_s = std::max(end_s, static_cast<double>(track->times_s().back()));
  const auto rate = even_rate(longest.times_s());
  const bool spans = static_cast<double>(longest.times_s().front()) <= animation.begin_s &&
                     static_cast<double>(longest.times_s().back()) >= end_s;
  if (rate && spans) {
    const auto& times = longest.times_s();
    const auto count = static_cast<std::ptrdiff_t>(std::min(most, times.size()));
    moments.times_s.assign(times.begin(), times.begin() + count);
    moments.rate_hz = *rate;
    return moments;
  }
  moments.rate_hz = kUsualRate_hz;
  const double frames = std::floor((end_s - animation.begin_s) * kUsualRate_hz + 1e-3) + 1.0;
  const auto count = std::min(most, static_cast<std::size_t>(frames));
  for (std::size_t f = 0; f < count; ++f)
    moments.times_s.push_back(animation.begin_s + static_cast<double>(f) / kUsualRate_hz);
  return moments;
}

Result<GlbAnimation> read_animation(const tinygltf::Model& model, std::size_t index,
                                    const GlbScene& scene, std::size_t& values_left) {
  const tinygltf::Animation& from = model.animations[index];
  GlbAnimation animation;
  animation.name = plain_name(from.name);
  for (const tinygltf::AnimationChannel& channel : from.channels) {
    const auto path = path_named(channel.target_path);
    if (!path || channel.target_node < 0) continue;
    const std::string what = "animation " + std::to_string(index) + ": ";
    if (static_cast<std::size_t>(channel.target_node) >= scene.nodes.size())
      return fail(what + "it moves a node that is not in the file");
    if (channel.sampler < 0 || static_cast<std::size_t>(channel.sampler) >= from.samplers.size())
      return fail(what + "a channel has no sampler");
    auto track = read_track(model, channel.target_node, *path,
                            from.samplers[static_cast<std::size_t>(channel.sampler)], values_left);
    if (!track) return fail(what + track.error().what);
    animation.tracks.push_back(std::move(*track));
  }
  if (animation.tracks.empty()) return animation;
  animation.begin_s = kLongest_s;
  for (const GlbTrack& track : animation.tracks) {
    const auto begin_s = static_cast<double>(track.times_s().front());
    const auto end_s = static_cast<double>(track.times_s().back());
    if (!(begin_s >= 0.0) || !(end_s < kLongest_s))
      return fail("animation " + std::to_string(index) + ": its times are no times of a dance");
    animation.begin_s = std::min(animation.begin_s, begin_s);
  }
  return animation;
}

}  // namespace dance
