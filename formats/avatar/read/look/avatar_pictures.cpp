#include "formats/avatar/read/look/avatar_pictures.h"

#include <string>

#include "formats/gltf/glb_accessor.h"
#include "formats/gltf/glb_json.h"
#include "formats/gltf/glb_text.h"
#include "formats/picture/picture.h"

namespace dance {

int AvatarPictures::of_texture(int index) {
  const auto& textures = source_.file.textures;
  if (index < 0 || static_cast<std::size_t>(index) >= textures.size()) {
    source_.note("a material names a picture that is not in the file");
    return -1;
  }
  const tinygltf::Texture& texture = textures[static_cast<std::size_t>(index)];
  // The WebP is the better one; what stands beside it is for those who cannot read it.
  const auto webp = index_in(member(extension_of(texture.extensions, "EXT_texture_webp"), "source"),
                             source_.file.images.size());
  if (!webp && texture.source < 0) {
    source_.note("a picture of a kind that is not read; export it as PNG or JPEG");
    return -1;
  }
  return of_image(webp.value_or(texture.source));
}

int AvatarPictures::of_image(int image) {
  const auto known = of_image_.find(image);
  if (known != of_image_.end()) return known->second;
  const auto decoded = decode(image);
  if (!decoded)
    source_.note("picture " + std::to_string(image) + " is left out: " + decoded.error().what);
  return of_image_[image] = decoded ? *decoded : -1;
}

Result<std::span<const std::uint8_t>> AvatarPictures::bytes_of(int index) const {
  const auto& images = source_.file.images;
  if (index < 0 || static_cast<std::size_t>(index) >= images.size())
    return fail("it is not in the file");
  const tinygltf::Image& image = images[static_cast<std::size_t>(index)];
  if (image.bufferView >= 0) return bytes_of_view(source_.file, image.bufferView);
  if (image.image.empty()) return fail("it is in another file; export all as one .glb");
  return std::span<const std::uint8_t>(image.image);
}

Result<int> AvatarPictures::decode(int image) {
  if (auto done = source_.go_on(); !done) return tl::make_unexpected(done.error());
  DANCE_TRY(const auto bytes, bytes_of(image));
  if (source_.model.pictures.size() >= source_.limits.pictures)
    return fail("more than " + std::to_string(source_.limits.pictures) + " pictures");
  const std::size_t needed = decoded_bytes(bytes);
  if (needed > decoded_left_) return fail("the pictures are too large together");
  PictureLimits limits;
  limits.side_px = source_.limits.picture_side_px;
  limits.reduced_side_px = source_.limits.reduced_side_px;
  limits.decoded_bytes = decoded_left_;
  // Also where it fails: that may be at its end.
  decoded_left_ -= needed;
  DANCE_TRY(RgbaPicture picture, read_picture(bytes, limits));
  if (auto taken = source_.take_bytes(picture.rgba.size()); !taken)
    return tl::make_unexpected(taken.error());
  source_.model.pictures.push_back({picture.width_px, picture.height_px, std::move(picture.rgba)});
  return static_cast<int>(source_.model.pictures.size()) - 1;
}

}  // namespace dance
