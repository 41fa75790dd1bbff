// FigureModels: the models of the lobby's figures. A second thread makes or reads them.
//
// Ownership:    owns its thread and at most kMostModels models; shares them.
// Threads:      the drawing thread.
// Failure:      a file that cannot be read gives no model.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "formats/body/guest_look.h"
#include "viewer/avatar/avatar_library.h"

namespace dance {

struct FigureChoice {
  std::string avatar;  // a file or a shipped avatar's name; "" = the mannequin
  GuestLook look;      // of the mannequin
  std::string key() const;
};

class FigureModels {
 public:
  static constexpr std::size_t kMostModels = 24;

  explicit FigureModels(AvatarSources sources) : sources_(std::move(sources)) {}

  // Call once a picture, before find(). Drops the models that were not requested recently.
  void begin_picture();
  // Null until it is ready.
  std::shared_ptr<const AvatarModel> find(const FigureChoice& choice, const Skeleton& skeleton);
  // True if the file of that choice cannot be shown.
  bool has_failed(const FigureChoice& choice, const Skeleton& skeleton) const;
  std::size_t models() const { return entries_.size(); }

 private:
  struct Entry {
    std::shared_ptr<AvatarJob> job;
    std::uint64_t last_used = 0;
  };
  static std::string key_of(const FigureChoice& choice, const Skeleton& skeleton);
  AvatarJob::Make make_of(const FigureChoice& choice, const Skeleton& skeleton) const;

  AvatarSources sources_;
  std::map<std::string, Entry> entries_;
  std::uint64_t picture_ = 0;
  AvatarLoader loader_;
};

}  // namespace dance
