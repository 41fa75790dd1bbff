#include "lobby/figures/figure_models.h"

#include <algorithm>
#include <utility>

#include "formats/avatar/mannequin_model.h"

namespace dance {
namespace {

// A figure that no picture has requested for this long is dropped if it is not ready yet.
constexpr std::uint64_t kPicturesWaited = 3;

void append(std::string& key, const Eigen::Vector3f& colour) {
  key.append(reinterpret_cast<const char*>(colour.data()), 3 * sizeof(float));
}

}  // namespace

std::string FigureChoice::key() const {
  if (!avatar.empty()) return "a" + avatar;
  std::string key = "m";
  for (const Eigen::Vector3f* colour : {&look.skin, &look.top, &look.legs, &look.shoes, &look.hair})
    append(key, *colour);
  key += static_cast<char>(look.sleeves);
  key += static_cast<char>(look.legwear);
  key += static_cast<char>(look.hair_style);
  return key;
}

std::string FigureModels::key_of(const FigureChoice& choice, const Skeleton& skeleton) {
  std::string key = choice.key();
  if (choice.avatar.empty()) MannequinShape(skeleton, true).append_to(key);
  return key;
}

AvatarJob::Make FigureModels::make_of(const FigureChoice& choice, const Skeleton& skeleton) const {
  if (choice.avatar.empty())
    return [shape = MannequinShape(skeleton, true), look = choice.look](const AvatarStop&) {
      return Result<AvatarModel>(mannequin_model(shape.skeleton(), look, true));
    };
  std::string file = choice.avatar;
  if (file.find('/') == std::string::npos)
    file = sources_.shipped_file ? sources_.shipped_file(file) : "";
  return [read = sources_.read_file, file](const AvatarStop& stop) -> AvatarJob::Made {
    if (!read || file.empty()) return Result<AvatarModel>(fail("there is no such avatar"));
    return read(file, stop);
  };
}

void FigureModels::begin_picture() {
  ++picture_;
  std::erase_if(entries_, [&](const auto& it) {
    return !it.second.job->is_done() && it.second.last_used + kPicturesWaited < picture_;
  });
  while (entries_.size() > kMostModels) {
    const auto oldest =
        std::ranges::min_element(entries_, {}, [](const auto& it) { return it.second.last_used; });
    entries_.erase(oldest);
  }
}

std::shared_ptr<const AvatarModel> FigureModels::find(const FigureChoice& choice,
                                                      const Skeleton& skeleton) {
  Entry& entry = entries_[key_of(choice, skeleton)];
  entry.last_used = picture_;
  if (!entry.job) entry.job = loader_.start(make_of(choice, skeleton));
  return entry.job->model_if_done();
}

bool FigureModels::has_failed(const FigureChoice& choice, const Skeleton& skeleton) const {
  const auto found = entries_.find(key_of(choice, skeleton));
  return found != entries_.end() && found->second.job->is_done() && !found->second.job->model();
}

}  // namespace dance
