// Writes a scene of actors as the JSON v3 text that Rokoko Studio streams.
//
// Units/frames: as formats/rokoko/rokoko_frame.h; six decimals.
// Ownership:    the text is a view of the writer's buffer until the next call; never allocates
//               after construction.
// Threads:      none inside; one owner.
// Failure:      write() stops before the actor with which the text would exceed its bound, and says
//               how many it wrote.
// Source:       keys as Rokoko's plugins for Blender, Unity and Unreal Engine read them. Blender's
//               insists on fps, scene.props, and meta.hasFace of each actor; with meta.hasGloves on
//               the fingers of both hands.
#pragma once

#include <string_view>
#include <vector>

#include "formats/rokoko/rokoko_frame.h"

namespace dance {

class RokokoWriter {
 public:
  // Of one actor with both hands.
  static constexpr std::size_t kMostActorBytes = 16'384;
  static constexpr std::size_t kMostTextBytes = RokokoFrame::kMostActors * kMostActorBytes + 512;

  struct Written {
    std::string_view text;
    std::size_t actors = 0;
  };

  RokokoWriter() { text_.reserve(kMostTextBytes); }
  // At most the first `most_actors`.
  Written write(const RokokoFrame& frame, std::size_t most_actors, std::size_t most_bytes);

 private:
  void add(std::string_view text) { text_.insert(text_.end(), text.begin(), text.end()); }
  void add_number(double value);
  void add_name(std::string_view name);
  void add_flag(std::string_view key, bool value);
  void add_actor(const RokokoActor& actor);
  void add_joint(std::string_view name, const RokokoJoint& joint);

  std::vector<char> text_;
};

}  // namespace dance
