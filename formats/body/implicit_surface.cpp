#include "formats/body/implicit_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dance {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr float kFar_m = 1e3f;
constexpr float kHem_m = 0.025f;
constexpr float kGradientStep_m = 5e-4f;
// Parts that grow together bulge where they meet. Those of a limb follow each other with equal
// radii, so that little growing rounds their edge and shows no ring at knee and elbow.
constexpr float kAlongLimb = 0.25f;
constexpr int kNewtonSteps = 3;

// A part with what its distance needs. In the plane of the axis and the place: u along the axis, v
// away from it, both in a space where the cross-section is round. The ball nearest to the place is
// the one at w = u − v tan α, where sin α = (ra − rb) / l is the taper.
class TaperedPart {
 public:
  explicit TaperedPart(const FigurePart& part)
      : a_m_(part.a_m),
        width_(part.width),
        depth_(part.depth),
        thinnest_(std::min({1.0f, part.width, part.depth})),
        limb_(static_cast<std::size_t>(part.limb)) {
    const Vector3f ab = part.b_m - part.a_m;
    length_m_ = ab.norm();
    const bool is_ball = length_m_ < 1e-5f;
    axis_ = is_ball ? Vector3f(part.side.unitOrthogonal()) : Vector3f(ab / length_m_);
    const Vector3f side = part.side - part.side.dot(axis_) * axis_;
    side_ = side.norm() > 1e-3f ? side.normalized() : Vector3f(axis_.unitOrthogonal());
    third_ = axis_.cross(side_);
    const float taper_m = part.radius_a_m - part.radius_b_m;
    radius_a_m_ = part.radius_a_m;
    if (length_m_ > std::abs(taper_m)) {
      sine_ = taper_m / length_m_;
      tangent_ = sine_ / std::sqrt(1.0f - sine_ * sine_);
    } else {  // one ball holds the other
      if (taper_m < 0.0f) a_m_ = part.b_m;
      radius_a_m_ = std::max(part.radius_a_m, part.radius_b_m);
      length_m_ = 0.0f;
    }
  }

  std::size_t limb() const { return limb_; }
  float distance_to(const Vector3f& place) const {
    const Vector3f from_a = place - a_m_;
    const float u = from_a.dot(axis_);
    const float s = from_a.dot(side_) / width_;
    const float t = from_a.dot(third_) / depth_;
    const float v = std::sqrt(s * s + t * t);
    const float w = std::clamp(u - v * tangent_, 0.0f, length_m_);
    return (std::sqrt((u - w) * (u - w) + v * v) - radius_a_m_ + sine_ * w) * thinnest_;
  }

 private:
  Vector3f a_m_;
  Vector3f axis_;
  Vector3f side_;
  Vector3f third_;
  float length_m_ = 0.0f;
  float radius_a_m_ = 0.0f;
  float sine_ = 0.0f;
  float tangent_ = 0.0f;
  float width_;
  float depth_;
  float thinnest_;
  std::size_t limb_;
};

// min(a, b), rounded where the two are within k of each other.
float smooth_min(float a, float b, float k) {
  if (k <= 0.0f) return std::min(a, b);
  const float h = std::max(k - std::abs(a - b), 0.0f) / k;
  return std::min(a, b) - 0.25f * h * h * k;
}

class Shape {
 public:
  explicit Shape(const FigureLayer& layer) : blend_m_(layer.blend_m), hem_y_m_(layer.hem_y_m) {
    for (const FigurePart& part : layer.parts) parts_.emplace_back(part);
  }

  float distance_to(const Vector3f& place) const {
    constexpr std::size_t kLimbs = 5;
    std::array<float, kLimbs> nearest;
    nearest.fill(kFar_m);
    for (const TaperedPart& part : parts_)
      nearest[part.limb()] = smooth_min(nearest[part.limb()], part.distance_to(place),
                                        part.limb() == 0 ? blend_m_ : kAlongLimb * blend_m_);
    float least = nearest[0];
    for (std::size_t limb = 1; limb < kLimbs; ++limb)
      if (nearest[limb] < kFar_m)
        least = std::min(least, smooth_min(nearest[0], nearest[limb], blend_m_));
    // The larger of the two, rounded as well: an edge has no normal.
    return -smooth_min(-least, place.y() - hem_y_m_, kHem_m);
  }

  Vector3f gradient(const Vector3f& place) const {
    Vector3f g;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3f step = kGradientStep_m * Vector3f::Unit(axis);
      g[axis] = (distance_to(place + step) - distance_to(place - step)) / (2.0f * kGradientStep_m);
    }
    return g;
  }

 private:
  std::vector<TaperedPart> parts_;
  float blend_m_;
  float hem_y_m_;
};

class Net {
 public:
  explicit Net(const FigureLayer& layer) : shape_(layer) {
    Eigen::AlignedBox3f box;
    for (const FigurePart& part : layer.parts) {
      const float stretch = std::max({1.0f, part.width, part.depth});
      const auto grown = [&](const Vector3f& p, float radius) {
        const Vector3f r = Vector3f::Constant(radius * stretch + layer.blend_m);
        box.extend(p - r);
        box.extend(p + r);
      };
      grown(part.a_m, part.radius_a_m);
      grown(part.b_m, part.radius_b_m);
    }
    const Vector3f size = box.sizes();
    cell_ = std::max(layer.cell_m, std::cbrt(size.prod() / static_cast<float>(kMostSamples)));
    origin_ = box.min() - Vector3f::Constant(cell_);
    for (int axis = 0; axis < 3; ++axis)
      counts_[axis] = static_cast<int>(std::ceil(size[axis] / cell_)) + 3;
  }

  Surface surface() {
    sample();
    place_vertices();
    join_vertices();
    return std::move(out_);
  }

 private:
  std::size_t index(const Vector3i& at) const {
    return (static_cast<std::size_t>(at.z()) * static_cast<std::size_t>(counts_.y()) +
            static_cast<std::size_t>(at.y())) *
               static_cast<std::size_t>(counts_.x()) +
           static_cast<std::size_t>(at.x());
  }
  Vector3f place(const Vector3i& at) const { return origin_ + cell_ * at.cast<float>(); }
  template <class Each>
  void for_all(int fewer, Each each) const {
    for (int z = 0; z + fewer < counts_.z(); ++z)
      for (int y = 0; y + fewer < counts_.y(); ++y)
        for (int x = 0; x + fewer < counts_.x(); ++x) each(Vector3i(x, y, z));
  }

  void sample() {
    values_.resize(static_cast<std::size_t>(counts_.x()) * static_cast<std::size_t>(counts_.y()) *
                   static_cast<std::size_t>(counts_.z()));
    vertex_of_.assign(values_.size(), kNone);
    for_all(0, [&](const Vector3i& at) { values_[index(at)] = shape_.distance_to(place(at)); });
  }

  void place_vertices() {
    for_all(1, [&](const Vector3i& at) {
      Vector3f sum = Vector3f::Zero();
      int crossings = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const Vector3i from = at + Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        for (int axis = 0; axis < 3; ++axis) {
          if (corner >> axis & 1) continue;
          const Vector3i to = from + Vector3i::Unit(axis);
          const float a = values_[index(from)];
          const float b = values_[index(to)];
          if ((a < 0.0f) == (b < 0.0f)) continue;
          sum += place(from) + a / (a - b) * (place(to) - place(from));
          ++crossings;
        }
      }
      if (crossings == 0) return;
      vertex_of_[index(at)] = static_cast<std::uint32_t>(out_.places_m.size());
      add_vertex(sum / static_cast<float>(crossings));
    });
  }

  void add_vertex(Vector3f place_m) {
    Vector3f g = shape_.gradient(place_m);
    for (int step = 0; step < kNewtonSteps && g.squaredNorm() > 1e-4f; ++step) {
      const Vector3f move = shape_.distance_to(place_m) / g.squaredNorm() * g;
      place_m -= move.norm() < cell_ ? move : Vector3f(cell_ * move.normalized());
      g = shape_.gradient(place_m);
    }
    out_.places_m.push_back(place_m);
    out_.normals.push_back(g.norm() > 1e-3f ? Vector3f(g.normalized()) : Vector3f::UnitY());
  }

  // Each edge of the grid that the surface crosses gives a quadrilateral of the four cells round
  // it.
  void join_vertices() {
    for_all(1, [&](const Vector3i& at) {
      for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        if (at[u] == 0 || at[v] == 0) continue;
        const bool begins_inside = values_[index(at)] < 0.0f;
        if (begins_inside == (values_[index(at + Vector3i::Unit(axis))] < 0.0f)) continue;
        const Vector3i down_u = at - Vector3i::Unit(u);
        const Vector3i down_v = at - Vector3i::Unit(v);
        std::array<std::uint32_t, 4> quad{vertex_of_[index(down_u - Vector3i::Unit(v))],
                                          vertex_of_[index(down_v)], vertex_of_[index(at)],
                                          vertex_of_[index(down_u)]};
        if (!begins_inside) std::swap(quad[1], quad[3]);
        add_quad(quad);
      }
    });
  }

  void add_quad(const std::array<std::uint32_t, 4>& q) {
    const auto apart = [&](std::size_t a, std::size_t b) {
      return (out_.places_m[q[a]] - out_.places_m[q[b]]).squaredNorm();
    };
    if (apart(0, 2) <= apart(1, 3))
      out_.triangles.insert(out_.triangles.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
    else
      out_.triangles.insert(out_.triangles.end(), {q[0], q[1], q[3], q[1], q[2], q[3]});
  }

  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  const Shape shape_;
  float cell_ = 0.0f;
  Vector3f origin_;
  Vector3i counts_;
  std::vector<float> values_;
  std::vector<std::uint32_t> vertex_of_;
  Surface out_;
};

}  // namespace

float signed_distance_m(const FigureLayer& layer, const Vector3f& place_m) {
  return Shape(layer).distance_to(place_m);
}

struct LayerDistance::Parts {
  Shape shape;
};
LayerDistance::LayerDistance(const FigureLayer& layer) : parts_(new Parts{Shape(layer)}) {}
LayerDistance::~LayerDistance() = default;
float LayerDistance::at(const Vector3f& place_m) const {
  return parts_->shape.distance_to(place_m);
}

Surface surface_of(const FigureLayer& layer) {
  return layer.parts.empty() ? Surface() : Net(layer).surface();
}

}  // namespace dance
