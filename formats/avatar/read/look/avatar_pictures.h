// The pictures of base colours, each decoded once, when a material first needs it.
//
// Units/frames: as AvatarPicture.
// Ownership:    refers to the source, and fills its model's pictures.
// Threads:      none inside.
// Failure:      -1 for a picture that is not there, or cannot be decoded, or is one too many; the
//               source has a note then.
// Source:       glTF 2.0, EXT_texture_webp.
#pragma once

#include <map>
#include <span>

#include "formats/avatar/read/avatar_source.h"

namespace dance {

class AvatarPictures {
 public:
  explicit AvatarPictures(AvatarSource& source)
      : source_(source), decoded_left_(source.limits.decoded_bytes) {}

  // The model's picture of one of the file's textures.
  int of_texture(int texture);

 private:
  int of_image(int image);
  Result<std::span<const std::uint8_t>> bytes_of(int image) const;
  Result<int> decode(int image);

  AvatarSource& source_;
  std::size_t decoded_left_;
  std::map<int, int> of_image_;
};

}  // namespace dance
