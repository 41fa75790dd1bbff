#include "formats/gltf/glb_container.h"

#include <algorithm>
#include <array>
#include <exception>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "core/base/byte_reader.h"
#include "formats/gltf/glb_text.h"
#include "formats/kind/file_content.h"

namespace dance {
namespace {

constexpr std::uint32_t kMagic = 0x46546c67;  // "glTF"
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN"
constexpr std::size_t kHeader_bytes = 12;
constexpr std::size_t kChunkHeader_bytes = 8;

// Counts braces and brackets outside strings; what lies deeper or is more than tinygltf may see is
// refused before it is parsed, as its parser recurses and allocates for each.
Result<void> check_json(std::string_view json, const GlbLimits& limits) {
  if (json.size() > limits.json_bytes)
    return fail("its JSON is larger than " + std::to_string(limits.json_bytes >> 20) + " MiB");
  std::size_t depth = 0;
  std::size_t objects = 0;
  std::size_t values = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > limits.json_depth) return fail("its JSON is nested too deeply");
      if (++objects > limits.json_objects) return fail("its JSON holds too many objects");
    } else if (c == '}' || c == ']') {
      if (depth > 0) --depth;
    } else if (c == ',') {
      if (++values > limits.json_values) return fail("its JSON holds too many values");
    }
  }
  return {};
}

// The JSON of a GLB whose chunks are whole.
Result<std::string_view> json_of(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  reader.u32();  // the magic, seen by the caller
  const std::uint32_t version = reader.u32();
  const std::uint32_t length = reader.u32();
  if (!reader.ok()) return fail("shorter than a GLB's header; copy it again");
  if (version != kVersion)
    return fail("glTF of version " + std::to_string(version) + "; export it as glTF 2.0");
  if (length > bytes.size() || length < kHeader_bytes + kChunkHeader_bytes)
    return fail("its header says " + std::to_string(length) + " bytes, but it has " +
                std::to_string(bytes.size()) + "; copy it again");
  const std::uint32_t json_bytes = reader.u32();
  if (reader.u32() != kJsonChunk || json_bytes > length - kHeader_bytes - kChunkHeader_bytes)
    return fail("no JSON at its beginning; copy it again");
  const std::string_view json = reader.text(json_bytes);
  const std::size_t behind = kHeader_bytes + kChunkHeader_bytes + json_bytes;
  if (length - behind == 0) return json;
  const std::uint32_t bin_bytes = reader.u32();
  const std::uint32_t type = reader.u32();
  if (!reader.ok() || type != kBinChunk || bin_bytes > length - behind - kChunkHeader_bytes)
    return fail("its binary part is cut off; copy it again");
  return json;
}

// Pictures stay packed as they are: in the file's buffer, or, where the JSON itself holds them, as
// a copy. Decoding them, with bounds, is up to the caller.
bool decode_no_picture(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                       const unsigned char* bytes, int size, void*) {
  image->as_is = true;
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

// tinygltf's own text repeats names of the file and gives no cure. Only the part of glTF that it
// complains of is taken from it.
Error damage_in(std::string_view json, std::string_view reported) {
  const nlohmann::json document = nlohmann::json::parse(json, nullptr, false);
  if (document.is_discarded())
    return {"damaged: its JSON breaks off or is no JSON; copy the file again, or export it again"};
  // Files that are packed may leave out what tinygltf looks for.
  if (document.is_object() && document.contains("extensionsRequired"))
    for (const auto& extension : document["extensionsRequired"])
      if (extension.is_string() && extension.get<std::string>().ends_with("_compression"))
        return {"packed with " + plain_name(extension.get<std::string>()) +
                "; export it without compression"};
  struct Part {
    std::string_view word, name;
  };
  // An image that lacks its bufferView is reported with both words: the image stands first.
  constexpr std::array kParts{
      Part{"asset", "asset"},        Part{"image", "images"},     Part{"bufferView", "bufferViews"},
      Part{"accessor", "accessors"}, Part{"primitive", "meshes"}, Part{"animation", "animations"},
      Part{"uffer", "buffers"},      Part{"texture", "textures"}, Part{"material", "materials"},
      Part{"mesh", "meshes"},        Part{"skin", "skins"},       Part{"scene", "scenes"},
      Part{"node", "nodes"}};
  const auto part = std::ranges::find_if(
      kParts, [&](const Part& it) { return reported.find(it.word) != reported.npos; });
  const std::string where =
      part == kParts.end() ? "it" : "'" + std::string(part->name) + "' in its JSON";
  return {"damaged: " + where +
          " is not as glTF 2.0 has it, or holds nothing; export it again as .glb"};
}

// A file brings its own data; what lies beside it is not opened, wherever its names point.
tinygltf::FsCallbacks no_files() {
  tinygltf::FsCallbacks none{};
  none.FileExists = [](const std::string&, void*) { return false; };
  none.ExpandFilePath = [](const std::string&, void*) { return std::string(); };
  none.ReadWholeFile = [](std::vector<unsigned char>*, std::string* error, const std::string&,
                          void*) {
    if (error) *error += "other files are not opened; export it as one .glb";
    return false;
  };
  none.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                           void*) { return false; };
  return none;
}

}  // namespace

Result<tinygltf::Model> unpacked_model(std::span<const std::uint8_t> bytes,
                                       const GlbLimits& limits) {
  if (bytes.size() > limits.file_bytes)
    return fail("larger than " + std::to_string(limits.file_bytes >> 20) + " MiB");
  if (bytes.size() < sizeof kMagic) return fail("no glTF file; copy it again");
  const bool is_binary = ByteReader(bytes).u32() == kMagic;
  const char* text = reinterpret_cast<const char*>(bytes.data());
  std::string_view json(text, bytes.size());
  if (is_binary) {
    DANCE_TRY(json, json_of(bytes));
  } else if (json[json.find_first_not_of(" \t\r\n") % json.size()] != '{') {
    const FileContent content = content_of(json);
    return content == FileContent::kUnknown
               ? fail("no glTF file: it begins neither with glTF nor with JSON")
               : fail(wrong_content(content, "a glTF file"));
  }
  if (auto checked = check_json(json, limits); !checked)
    return tl::make_unexpected(checked.error());
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks(no_files());
  parser.SetImageLoader(&decode_no_picture, nullptr);
  tinygltf::Model model;
  std::string error;
  std::string warning;
  const auto size = static_cast<unsigned int>(bytes.size());
  bool parsed = false;
  // tinygltf throws at some files, for example at an empty binary chunk.
  try {
    parsed = is_binary ? parser.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size)
                       : parser.LoadASCIIFromString(&model, &error, &warning, text, size, "");
  } catch (const std::exception&) {
    error.clear();
  }
  constexpr std::string_view kMissing = "File not found : ";
  if (const std::size_t at = error.find(kMissing); !parsed && at != error.npos)
    return fail("its data lies in another file, " +
                plain_name(std::string_view(error).substr(at + kMissing.size())) +
                ", which is not opened; export it as one .glb");
  if (!parsed) return tl::make_unexpected(damage_in(json, error));
  return model;
}

Result<std::vector<std::uint8_t>> packed_glb(const tinygltf::Model& model) {
  tinygltf::TinyGLTF writer;
  std::ostringstream stream;
  if (!writer.WriteGltfSceneToStream(&model, stream, false, true) || !stream)
    return fail("the GLB cannot be put together: out of memory?");
  const std::string_view bytes = stream.view();
  return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
}

}  // namespace dance
