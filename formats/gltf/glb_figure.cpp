#include "formats/gltf/glb_figure.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "formats/bvh/euler_zxy.h"
#include "formats/gltf/glb_text.h"
#include "formats/gltf/glb_vrm.h"

namespace dance {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// A joint whose distance from its parent changes by more than this gets channels for it.
constexpr double kMoves_m = 2e-5;

struct Places {
  std::vector<Eigen::Affine3d> T_WN;
  std::vector<Quaterniond> R_WN;

  explicit Places(std::size_t nodes) : T_WN(nodes), R_WN(nodes) {}
  Vector3d place(int node) const { return T_WN[static_cast<std::size_t>(node)].translation(); }
  const Quaterniond& rotation(int node) const { return R_WN[static_cast<std::size_t>(node)]; }

  void find(const GlbScene& scene, const std::vector<int>& nodes,
            const std::vector<GlbTransform>& transforms) {
    for (const int node : nodes) {
      const auto n = static_cast<std::size_t>(node);
      const GlbTransform& local = transforms[n];
      T_WN[n] = Eigen::Translation3d(local.translation) * local.rotation *
                Eigen::AlignedScaling3d(local.scale);
      R_WN[n] = local.rotation;
      if (scene.at(node).parent < 0) continue;
      const auto parent = static_cast<std::size_t>(scene.at(node).parent);
      T_WN[n] = T_WN[parent] * T_WN[n];
      R_WN[n] = (R_WN[parent] * R_WN[n]).normalized();
    }
  }
};

using NamedRoots = std::vector<std::pair<int, std::string>>;

int root_of_skin(const tinygltf::Skin& skin, const GlbScene& scene) {
  const std::set<int> joints(skin.joints.begin(), skin.joints.end());
  for (const int joint : skin.joints) {
    if (joint < 0 || static_cast<std::size_t>(joint) >= scene.nodes.size()) return -1;
    if (!joints.contains(scene.at(joint).parent)) return joint;
  }
  return -1;
}

// The topmost joints of all skins, with the name of the first skin that begins there, but for those
// below another. In time that grows with the file alone: there may be very many skins.
NamedRoots roots_of_skins(const tinygltf::Model& model, const GlbScene& scene) {
  std::vector<bool> is_root(scene.nodes.size(), false);
  NamedRoots roots;
  for (const tinygltf::Skin& skin : model.skins) {
    const int root = root_of_skin(skin, scene);
    if (root < 0 || is_root[static_cast<std::size_t>(root)]) continue;
    is_root[static_cast<std::size_t>(root)] = true;
    roots.emplace_back(root, plain_name(skin.name));
  }
  std::vector<bool> is_below(scene.nodes.size(), false);
  for (const int node : scene.parents_first) {
    if (scene.at(node).parent < 0) continue;
    const auto parent = static_cast<std::size_t>(scene.at(node).parent);
    is_below[static_cast<std::size_t>(node)] = is_below[parent] || is_root[parent];
  }
  std::erase_if(roots,
                [&](const auto& it) { return is_below[static_cast<std::size_t>(it.first)]; });
  return roots;
}

GlbFigure figure_from(const GlbScene& scene, int root, std::string name) {
  GlbFigure figure;
  figure.name = std::move(name);
  for (int n = scene.at(root).parent; n >= 0; n = scene.at(n).parent) figure.above.push_back(n);
  std::reverse(figure.above.begin(), figure.above.end());
  // Depth first, as BVH nests.
  std::vector<int> open{root};
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    figure.joints.push_back(node);
    const auto& children = scene.at(node).children;
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  return figure;
}

class FigureMotion {
 public:
  FigureMotion(const GlbFigure& figure, const GlbScene& scene)
      : figure_(figure), scene_(scene), rest_(scene.nodes.size()), now_(scene.nodes.size()) {
    nodes_ = figure.above;
    nodes_.insert(nodes_.end(), figure.joints.begin(), figure.joints.end());
    transforms_.resize(scene.nodes.size());
    for (const int node : nodes_) transform(node) = scene.at(node).rest;
    rest_.find(scene, nodes_, transforms_);
  }

  void begin_joints(Bvh& bvh) const {
    bvh.positions_replace_offsets = true;
    for (const int node : figure_.joints) {
      BvhJoint joint;
      const auto bone = figure_.bones.find(node);
      joint.name = bone != figure_.bones.end() ? bone->second : scene_.at(node).name;
      const bool is_root = bvh.joints.empty();
      joint.parent = is_root ? -1 : index_of_node(scene_.at(node).parent);
      joint.offset = is_root ? rest_.place(node)
                             : Vector3d(rest_.place(node) - rest_.place(scene_.at(node).parent));
      bvh.joints.push_back(std::move(joint));
    }
  }

  void move_to(double time_s, const std::vector<const GlbTrack*>& tracks) {
    for (const GlbTrack* track : tracks) track->apply(time_s, transform(track->node()));
    now_.find(scene_, nodes_, transforms_);
  }

  // A joint's rotation from its rest, in the world's axes, and where it is seen from its parent.
  Quaterniond turn(int node) const {
    return now_.rotation(node) * rest_.rotation(node).conjugate();
  }
  Vector3d seen_from_parent(std::size_t joint, const Bvh& bvh) const {
    const int node = figure_.joints[joint];
    if (bvh.joints[joint].parent < 0) return now_.place(node);
    const int parent = scene_.at(node).parent;
    return turn(parent).conjugate() * (now_.place(node) - now_.place(parent));
  }
  Quaterniond turn_from_parent(std::size_t joint, const Bvh& bvh) const {
    const int node = figure_.joints[joint];
    if (bvh.joints[joint].parent < 0) return turn(node);
    return turn(scene_.at(node).parent).conjugate() * turn(node);
  }

 private:
  GlbTransform& transform(int node) { return transforms_[static_cast<std::size_t>(node)]; }
  int index_of_node(int node) const {
    const auto found = std::find(figure_.joints.begin(), figure_.joints.end(), node);
    return static_cast<int>(found - figure_.joints.begin());
  }

  const GlbFigure& figure_;
  const GlbScene& scene_;
  std::vector<int> nodes_;
  std::vector<GlbTransform> transforms_;
  Places rest_;
  Places now_;
};

void add_channels(const std::vector<bool>& moves, Bvh& bvh) {
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    BvhJoint& joint = bvh.joints[j];
    joint.first_channel = bvh.channel_count;
    const auto add = [&joint](BvhChannel channel) {
      joint.channels[joint.channel_count++] = channel;
    };
    if (moves[j])
      for (const auto channel :
           {BvhChannel::kXPosition, BvhChannel::kYPosition, BvhChannel::kZPosition})
        add(channel);
    for (const auto channel :
         {BvhChannel::kZRotation, BvhChannel::kXRotation, BvhChannel::kYRotation})
      add(channel);
    bvh.channel_count += joint.channel_count;
  }
}

std::vector<GlbFigure> figures_below(const NamedRoots& roots, const tinygltf::Model& model,
                                     const GlbScene& scene) {
  std::vector<GlbFigure> figures;
  const std::map<int, std::string> bones = vrm_bones(model);
  for (const auto& [root, name] : roots) {
    figures.push_back(figure_from(scene, root, name));
    for (const int joint : figures.back().joints)
      if (const auto bone = bones.find(joint); bone != bones.end())
        figures.back().bones.insert(*bone);
  }
  return figures;
}

}  // namespace

std::vector<GlbFigure> find_figures(const tinygltf::Model& model, const GlbScene& scene) {
  const NamedRoots roots = roots_of_skins(model, scene);
  return roots.empty() ? figures_of_trees(model, scene) : figures_below(roots, model, scene);
}

std::vector<GlbFigure> figures_of_trees(const tinygltf::Model& model, const GlbScene& scene) {
  NamedRoots roots;
  for (std::size_t n = 0; n < scene.nodes.size(); ++n)
    if (scene.nodes[n].parent < 0)
      roots.emplace_back(static_cast<int>(n), plain_name(scene.nodes[n].name));
  return figures_below(roots, model, scene);
}

std::vector<const GlbTrack*> tracks_of(const GlbFigure& figure, const GlbAnimation& animation,
                                       const GlbScene& scene) {
  std::vector<bool> is_of_figure(scene.nodes.size(), false);
  for (const int node : figure.above) is_of_figure[static_cast<std::size_t>(node)] = true;
  for (const int node : figure.joints) is_of_figure[static_cast<std::size_t>(node)] = true;
  std::vector<const GlbTrack*> tracks;
  for (const GlbTrack& track : animation.tracks)
    if (is_of_figure[static_cast<std::size_t>(track.node())]) tracks.push_back(&track);
  return tracks;
}

Bvh rest_of(const GlbFigure& figure, const GlbScene& scene) {
  Bvh bvh;
  FigureMotion(figure, scene).begin_joints(bvh);
  return bvh;
}

GlbFigure figure_below(const GlbScene& scene, int root) {
  return figure_from(scene, root, plain_name(scene.at(root).name));
}

Result<Bvh> bvh_of(const GlbFigure& figure, const GlbScene& scene, const GlbAnimation& animation,
                   const GlbLimits& limits) {
  if (figure.joints.size() > limits.joints)
    return fail("a figure with more than " + std::to_string(limits.joints) + " joints");
  const std::vector<const GlbTrack*> tracks = tracks_of(figure, animation, scene);
  const GlbMoments moments = moments_of(animation, tracks, limits.frames + 1);
  if (moments.times_s.size() > limits.frames)
    return fail("a dance of more than " + std::to_string(limits.frames) + " frames");
  FigureMotion motion(figure, scene);
  Bvh bvh;
  motion.begin_joints(bvh);
  bvh.frame_hz = moments.rate_hz;
  bvh.frame_count = moments.times_s.size();
  std::vector<bool> moves(bvh.joints.size(), false);
  moves[0] = true;
  for (const double time_s : moments.times_s) {
    motion.move_to(time_s, tracks);
    for (std::size_t j = 1; j < bvh.joints.size(); ++j)
      if (!moves[j])
        moves[j] = (motion.seen_from_parent(j, bvh) - bvh.joints[j].offset).norm() > kMoves_m;
  }
  add_channels(moves, bvh);
  if (bvh.frame_count * bvh.channel_count > limits.values)
    return fail("a dance of more numbers than fit in memory");
  bvh.values.reserve(bvh.frame_count * bvh.channel_count);
  for (const double time_s : moments.times_s) {
    motion.move_to(time_s, tracks);
    for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
      if (moves[j])
        for (const double value : Vector3d(motion.seen_from_parent(j, bvh)))
          bvh.values.push_back(static_cast<float>(value));
      for (const double angle_deg : euler_zxy_deg(motion.turn_from_parent(j, bvh)))
        bvh.values.push_back(static_cast<float>(angle_deg));
    }
  }
  for (const float value : bvh.values)
    if (!std::isfinite(value)) return fail("a dance whose numbers are too large");
  return bvh;
}

}  // namespace dance
