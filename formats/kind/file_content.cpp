#include "formats/kind/file_content.h"

#include <lzma.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <memory>

namespace dance {
namespace {

using std::string_view_literals::operator""sv;

constexpr std::string_view kPlaysIt = "dance replay, dance view and dance convert take it";
constexpr std::string_view kUnpackIt = "unpack it first, and name the file in it";
constexpr std::string_view kExportIt = "export it as .glb or .bvh, for example with Blender";

struct Described {
  FileContent content;
  std::string_view name;
  std::string_view cure;
};
constexpr std::array kDescribed{
    Described{FileContent::kUnknown, "of no known kind", "name another file"},
    Described{FileContent::kEmpty, "empty", "copy it again"},
    Described{FileContent::kLcmLog, "an LCM log", kPlaysIt},
    Described{FileContent::kBvh, "a BVH motion file", kPlaysIt},
    Described{FileContent::kGlb, "a glTF file",
              "dance replay and dance view take its dances, dance avatar choose its figure"},
    Described{FileContent::kGltf, "a glTF file",
              "dance replay and dance view take its dances, dance avatar choose its figure"},
    Described{FileContent::kMcap, "an MCAP file", kPlaysIt},
    Described{FileContent::kTable, "a table (CSV)", kPlaysIt},
    Described{FileContent::kSessionFile, "a session file", "dance join takes it"},
    Described{FileContent::kSound, "a sound file", "dance music takes it"},
    Described{FileContent::kFilm, "a film", "dance capture takes it"},
    Described{FileContent::kPicture, "a picture", "name a recording"},
    Described{FileContent::kLcmType, "an LCM type definition",
              "lcm-gen takes it; a log is what dance record writes"},
    Described{FileContent::kLogIndex, "the index of a log", "name the log beside it"},
    Described{FileContent::kZip, "a ZIP archive", kUnpackIt},
    Described{FileContent::kGzip, "packed with gzip", "unpack it first with gunzip"},
    Described{FileContent::kXz, "packed with xz", "unpack it first with xz -d"},
    Described{FileContent::kZstd, "packed with zstd", "unpack it first with zstd -d"},
    Described{FileContent::kBzip2, "packed with bzip2", "unpack it first with bunzip2"},
    Described{FileContent::kSevenZip, "a 7z archive", kUnpackIt},
    Described{FileContent::kRar, "a RAR archive", kUnpackIt},
    Described{FileContent::kTar, "a tar archive", kUnpackIt},
    Described{FileContent::kFilePointer, "a pointer of Git LFS or git-annex",
              "fetch the file with git lfs pull or git annex get"},
    Described{FileContent::kFbx, "an FBX file", kExportIt},
    Described{FileContent::kBlend, "a Blender scene", "export it as .glb or .bvh in Blender"},
    Described{FileContent::kC3d, "a C3D file of markers",
              "solve it to a skeleton and export that as .bvh"},
    Described{FileContent::kRosBag, "a ROS bag", "convert it to MCAP"},
    Described{FileContent::kDatabase, "an SQLite database", "export MCAP, if it is a ROS 2 bag"},
    Described{FileContent::kAcclaim, "an Acclaim file (ASF/AMC)", "convert it to .bvh"},
    Described{FileContent::kCollada, "a COLLADA file", kExportIt},
    Described{FileContent::kWebPage, "a web page", "download the file itself"},
    Described{FileContent::kJson, "JSON, and no glTF", "name another file"},
};

const Described& described(FileContent content) {
  const auto* const found = std::find_if(kDescribed.begin(), kDescribed.end(),
                                         [&](const Described& d) { return d.content == content; });
  return found == kDescribed.end() ? kDescribed.front() : *found;
}

// Bytes that only one kind begins with.
struct Magic {
  std::size_t at;
  std::string_view bytes;
  FileContent content;
};
constexpr std::array kMagics{
    Magic{0, "\xED\xA1\xDA\x01"sv, FileContent::kLcmLog},
    Magic{0, "glTF"sv, FileContent::kGlb},
    Magic{0, "\x89MCAP0\r\n"sv, FileContent::kMcap},
    Magic{0, "DANCEIDX"sv, FileContent::kLogIndex},
    Magic{0, "PK\3\4"sv, FileContent::kZip},
    Magic{0, "PK\5\6"sv, FileContent::kZip},
    Magic{0, "\x1F\x8B"sv, FileContent::kGzip},
    Magic{0, "\xFD\x37zXZ\0"sv, FileContent::kXz},
    Magic{0, "\x28\xB5\x2F\xFD"sv, FileContent::kZstd},
    Magic{0, "BZh"sv, FileContent::kBzip2},
    Magic{0, "7z\xBC\xAF\x27\x1C"sv, FileContent::kSevenZip},
    Magic{0, "Rar!\x1A\x07"sv, FileContent::kRar},
    Magic{257, "ustar"sv, FileContent::kTar},
    Magic{0, "version https://git-lfs"sv, FileContent::kFilePointer},
    Magic{0, "/annex/objects/"sv, FileContent::kFilePointer},
    Magic{0, "Kaydara FBX Binary"sv, FileContent::kFbx},
    Magic{0, "; FBX "sv, FileContent::kFbx},
    Magic{0, "BLENDER"sv, FileContent::kBlend},
    Magic{0, "#ROSBAG"sv, FileContent::kRosBag},
    Magic{0, "SQLite format 3\0"sv, FileContent::kDatabase},
    Magic{0, "fLaC"sv, FileContent::kSound},
    Magic{0, "ID3"sv, FileContent::kSound},
    Magic{0, "OggS"sv, FileContent::kSound},
    Magic{8, "WAVEfmt "sv, FileContent::kSound},
    Magic{8, "AIFF"sv, FileContent::kSound},
    Magic{0, "caff"sv, FileContent::kSound},
    Magic{4, "ftypM4A"sv, FileContent::kSound},
    Magic{4, "ftyp"sv, FileContent::kFilm},
    Magic{0, "\x1A\x45\xDF\xA3"sv, FileContent::kFilm},
    Magic{8, "AVI LIST"sv, FileContent::kFilm},
    Magic{8, "WEBPVP8"sv, FileContent::kPicture},
    Magic{0, "\x89PNG\r\n\x1A\n"sv, FileContent::kPicture},
    Magic{0, "\xFF\xD8\xFF"sv, FileContent::kPicture},
    Magic{0, "GIF8"sv, FileContent::kPicture},
};

bool has_at(std::string_view head, std::size_t at, std::string_view bytes) {
  return head.size() >= at && head.substr(at).starts_with(bytes);
}

bool starts_ignoring_case(std::string_view text, std::string_view start) {
  return text.size() >= start.size() &&
         std::equal(start.begin(), start.end(), text.begin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) ==
                  std::tolower(static_cast<unsigned char>(b));
         });
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string_view behind_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text;
}

// The rest behind blanks and comments; a comment reaches from `comment` to the end of its line.
std::string_view behind_comments(std::string_view text, std::string_view comment) {
  for (;;) {
    text = behind_blanks(text);
    if (text.starts_with(comment)) {
      text.remove_prefix(std::min(text.find('\n'), text.size()));
    } else if (comment == "//" && text.starts_with("/*")) {
      const std::size_t end = text.find("*/");
      text.remove_prefix(end == text.npos ? text.size() : end + 2);
    } else {
      return text;
    }
  }
}

std::string_view first_line(std::string_view text) {
  return text.substr(0, text.find_first_of("\r\n"));
}

bool is_table(std::string_view text) {
  const std::string_view names = first_line(text);
  return names.find_first_of(",;\t") != names.npos && names.find("guest") != names.npos &&
         names.find("hips_") != names.npos;
}

bool is_lcm_type(std::string_view text) {
  const std::string_view code = behind_comments(text, "//");
  const bool begins = code.starts_with("package ") || code.starts_with("struct ");
  const auto has_member = [&](std::string_view type) {
    return code.find(std::string(type) + " ") != code.npos;
  };
  constexpr std::array kTypes{"int8_t"sv, "int16_t"sv, "int32_t"sv, "int64_t"sv, "byte"sv,
                              "float"sv,  "double"sv,  "string"sv,  "boolean"sv};
  return begins && code.find("struct ") != code.npos && code.find('{') != code.npos &&
         (std::any_of(kTypes.begin(), kTypes.end(), has_member) || code.starts_with("package "));
}

// "[house]" or "[[route]]" as the first line that is no comment.
bool is_session_file(std::string_view text) {
  std::string_view line = first_line(behind_comments(text, "#"));
  const std::size_t begin = line.find_first_not_of('[');
  if (begin == 0 || begin > 2 || begin == line.npos) return false;
  const std::size_t end = line.find_first_not_of("abcdefghijklmnopqrstuvwxyz-_", begin);
  return end != line.npos && end > begin && line[end] == ']';
}

FileContent content_of_json(std::string_view text) {
  for (const std::string_view word : {"\"asset\""sv, "\"bufferViews\""sv, "\"accessors\""sv})
    if (text.find(word) != text.npos) return FileContent::kGltf;
  return FileContent::kJson;
}

FileContent content_of_text(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const std::string_view begun = behind_blanks(text);
  if (starts_ignoring_case(begun, "HIERARCHY")) return FileContent::kBvh;
  if (begun.starts_with('{')) return content_of_json(begun);
  if (starts_ignoring_case(begun, "<!doctype html") || starts_ignoring_case(begun, "<html"))
    return FileContent::kWebPage;
  if (begun.starts_with('<') && begun.find("<COLLADA") != begun.npos) return FileContent::kCollada;
  const std::string_view code = behind_comments(text, "#");
  if (code.starts_with(":version") || code.starts_with(":FULLY-SPECIFIED"))
    return FileContent::kAcclaim;
  if (is_table(text)) return FileContent::kTable;
  if (is_session_file(text)) return FileContent::kSessionFile;
  if (is_lcm_type(text)) return FileContent::kLcmType;
  return FileContent::kUnknown;
}

// The first bytes of what an xz file holds; "" of one that cannot be unpacked.
std::string unpacked_head(std::string_view packed) {
  constexpr std::uint64_t kMemory_bytes = std::uint64_t{128} << 20;
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, kMemory_bytes, 0) != LZMA_OK) return "";
  std::string head(1024, '\0');
  stream.next_in = reinterpret_cast<const std::uint8_t*>(packed.data());
  stream.avail_in = packed.size();
  stream.next_out = reinterpret_cast<std::uint8_t*>(head.data());
  stream.avail_out = head.size();
  while (stream.avail_out > 0 && lzma_code(&stream, LZMA_RUN) == LZMA_OK) {
  }
  head.resize(head.size() - stream.avail_out);
  lzma_end(&stream);
  return head;
}

// An event's header somewhere: a log whose beginning is damaged.
bool holds_log_event(std::string_view head) {
  constexpr std::size_t kHeader_bytes = 28;
  const auto number_at = [&](std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i)
      number = number << 8 | static_cast<unsigned char>(head[at + i]);
    return number;
  };
  for (std::size_t at = head.find("\xED\xA1\xDA\x01"); at != head.npos;
       at = head.find("\xED\xA1\xDA\x01", at + 1))
    if (head.size() - at >= kHeader_bytes && number_at(at + 20) > 0 && number_at(at + 20) < 64 &&
        number_at(at + 24) < (1u << 25))
      return true;
  return false;
}

// A C3D file begins with one byte for the place of its parameters, and 0x50.
bool is_c3d(std::string_view head) {
  return head.size() >= 512 && head[1] == 0x50 && head[0] > 1 && head[0] < 16;
}

bool is_mpeg_sound(std::string_view head) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(head[i]); };
  return head.size() > 3 && byte(0) == 0xFF && (byte(1) & 0xE6u) == 0xE2u;
}

}  // namespace

FileContent content_of(std::string_view head) {
  head = head.substr(0, kHead_bytes);
  if (head.empty()) return FileContent::kEmpty;
  const auto* const magic = std::find_if(
      kMagics.begin(), kMagics.end(), [&](const Magic& m) { return has_at(head, m.at, m.bytes); });
  if (magic != kMagics.end()) {
    if (magic->content != FileContent::kXz) return magic->content;
    return content_of_text(unpacked_head(head)) == FileContent::kBvh ? FileContent::kBvh
                                                                     : FileContent::kXz;
  }
  if (const FileContent text = content_of_text(head); text != FileContent::kUnknown) return text;
  if (holds_log_event(head)) return FileContent::kLcmLog;
  if (is_mpeg_sound(head)) return FileContent::kSound;
  if (is_c3d(head)) return FileContent::kC3d;
  return FileContent::kUnknown;
}

FileContent content_of_file(const std::string& path) {
  struct stat found {};
  // A pipe would be read empty.
  if (::stat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return FileContent::kUnknown;
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rbe"));
  if (!file) return FileContent::kUnknown;
  std::string head(kHead_bytes, '\0');
  head.resize(std::fread(head.data(), 1, head.size(), file.get()));
  if (std::ferror(file.get()) != 0) return FileContent::kUnknown;
  return content_of(head);
}

std::string_view content_name(FileContent content) { return described(content).name; }

std::string wrong_content(FileContent content, std::string_view wanted) {
  const Described& it = described(content);
  return std::string(it.name) + ", not " + std::string(wanted) + "; " + std::string(it.cure);
}

Result<void> check_content(const std::string& path, std::initializer_list<FileContent> readable,
                           std::string_view wanted) {
  const FileContent content = content_of_file(path);
  if (content == FileContent::kUnknown || content == FileContent::kEmpty ||
      std::find(readable.begin(), readable.end(), content) != readable.end())
    return {};
  return fail(path + ": " + wrong_content(content, wanted));
}

}  // namespace dance
