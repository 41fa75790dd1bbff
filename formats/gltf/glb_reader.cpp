#include <algorithm>

#include "formats/gltf/glb.h"
#include "formats/gltf/glb_container.h"
#include "formats/gltf/glb_figure.h"
#include "formats/gltf/glb_scene.h"

namespace dance {
namespace {

// Packing that changes where the numbers of animations are found. What packs only meshes and
// pictures does not matter here.
constexpr std::string_view kPacked[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

Result<void> check_extensions(const tinygltf::Model& model) {
  for (const std::string_view packed : kPacked)
    if (std::find(model.extensionsUsed.begin(), model.extensionsUsed.end(), packed) !=
        model.extensionsUsed.end())
      return fail("packed with " + std::string(packed) + "; export it without compression");
  return {};
}

std::string name_of(const GlbFigure& figure, std::size_t figures, const GlbAnimation& animation,
                    std::size_t animations) {
  if (animations < 2 || animation.name.empty())
    return !figure.name.empty() ? figure.name : animation.name;
  return figures < 2 ? animation.name : figure.name + " " + animation.name;
}

// Reads the dances of some figures from all animations of a file.
class DanceReader {
 public:
  DanceReader(const tinygltf::Model& model, const GlbScene& scene, const GlbLimits& limits,
              const RetargetOptions& options)
      : model_(model), scene_(scene), limits_(limits), options_(options) {}

  Result<void> read(const std::vector<GlbFigure>& figures) {
    std::size_t values_left = limits_.values;  // of the clips that are kept
    std::size_t keys_left = values_left;       // of the whole file: animations may share accessors
    for (std::size_t a = 0; a < model_.animations.size(); ++a) {
      DANCE_TRY(const GlbAnimation animation, read_animation(model_, a, scene_, keys_left));
      for (const GlbFigure& figure : figures) {
        if (tracks_of(figure, animation, scene_).empty()) continue;
        auto bvh = bvh_of(figure, scene_, animation, limits_);
        auto retargeted = bvh ? retarget(*bvh, options_) : tl::make_unexpected(bvh.error());
        if (!retargeted) {
          if (why_.empty()) why_ = retargeted.error().what;
          continue;
        }
        const std::size_t values = bvh->values.size();
        if (clips_.size() == limits_.clips || values > values_left)
          return fail("more dances than fit in memory; export fewer of its animations");
        values_left -= values;
        clips_.push_back({name_of(figure, figures.size(), animation, model_.animations.size()),
                          std::move(retargeted->clip), std::move(retargeted->notes)});
      }
    }
    return {};
  }
  bool has_found() const { return !clips_.empty(); }
  // The error of the first figure that could not be read.
  const std::string& why() const { return why_; }
  std::vector<NamedClip> take() { return std::move(clips_); }

 private:
  const tinygltf::Model& model_;
  const GlbScene& scene_;
  const GlbLimits& limits_;
  const RetargetOptions& options_;
  std::vector<NamedClip> clips_;
  std::string why_;
};

}  // namespace

Result<std::vector<NamedClip>> read_glb(std::span<const std::uint8_t> bytes,
                                        const GlbLimits& limits, const RetargetOptions& options) {
  DANCE_TRY(const tinygltf::Model model, unpacked_model(bytes, limits));
  if (auto checked = check_extensions(model); !checked) return tl::make_unexpected(checked.error());
  DANCE_TRY(const GlbScene scene, checked_scene(model, limits));
  if (model.animations.empty())
    return fail(
        "no animation; the file holds figures without motion: dance avatar choose "
        "draws a dancer so");
  const std::vector<GlbFigure> figures = find_figures(model, scene);
  if (figures.empty()) return fail("no human figure; export the skeleton with its animation");
  DanceReader reader(model, scene, limits, options);
  if (auto read = reader.read(figures); !read) return tl::make_unexpected(read.error());
  if (!reader.has_found() && !model.skins.empty())
    if (auto read = reader.read(figures_of_trees(model, scene)); !read)
      return tl::make_unexpected(read.error());
  if (!reader.has_found())
    return fail(reader.why().empty()
                    ? "its animations move no figure; export the skeleton with them"
                    : reader.why());
  return reader.take();
}

}  // namespace dance
