// GLB files that are damaged, or made to do harm.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "tests/formats/gltf/glb_clips.h"

namespace dance {
namespace {

using Bytes = std::vector<std::uint8_t>;
using test::random_dance;

void put_u32(Bytes& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    out.push_back(static_cast<std::uint8_t>(value >> shift));
}

Bytes glb_of(std::string json, const Bytes& bin = {}) {
  while (json.size() % 4 != 0) json += ' ';
  Bytes out;
  put_u32(out, 0x46546c67);
  put_u32(out, 2);
  put_u32(out, static_cast<std::uint32_t>(20 + json.size() + (bin.empty() ? 0 : 8 + bin.size())));
  put_u32(out, static_cast<std::uint32_t>(json.size()));
  put_u32(out, 0x4e4f534a);
  out.insert(out.end(), json.begin(), json.end());
  if (bin.empty()) return out;
  put_u32(out, static_cast<std::uint32_t>(bin.size()));
  put_u32(out, 0x004e4942);
  out.insert(out.end(), bin.begin(), bin.end());
  return out;
}

std::string error_of(const Bytes& bytes, const GlbLimits& limits = {}) {
  const auto clips = read_glb(bytes, limits);
  return clips ? "was read" : clips.error().what;
}

void expect_error(const Bytes& bytes, const std::string& part, const GlbLimits& limits = {}) {
  const std::string error = error_of(bytes, limits);
  EXPECT_NE(error.find(part), error.npos) << error;
}

// Floats 0, 1, 2, ….
Bytes floats(std::size_t count) {
  Bytes out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<float>(i);
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    put_u32(out, bits);
  }
  return out;
}

// An animation of one node from two accessors, which are to be spoilt.
Bytes moving(const std::string& view, const std::string& times, const std::string& values,
             const std::string& nodes = R"([{"name":"hips"}])", const Bytes& bin = floats(16)) {
  return glb_of(R"({"asset":{"version":"2.0"},"nodes":)" + nodes + R"(,"buffers":[{"byteLength":)" +
                    std::to_string(bin.size()) + R"(}],"bufferViews":[)" + view +
                    R"(],"accessors":[)" + times + "," + values +
                    R"(],"animations":[{"samplers":[{"input":0,"output":1}],)"
                    R"("channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}]})",
                bin);
}
constexpr const char* kView = R"({"buffer":0,"byteLength":64})";
constexpr const char* kTimes =
    R"({"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]})";
constexpr const char* kValues = R"({"bufferView":0,"componentType":5126,"count":2,"type":"VEC3"})";

TEST(GlbHostile, RefusesEmptyBuffersAtWhichTinygltfThrows) {
  Bytes bytes = glb_of(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":0}]})");
  put_u32(bytes, 0);
  put_u32(bytes, 0x004e4942);
  bytes[8] = static_cast<std::uint8_t>(bytes.size());
  const std::string kError =
      "damaged: it is not as glTF 2.0 has it, or holds nothing; export it again as .glb";
  EXPECT_EQ(error_of(bytes), kError);
  EXPECT_EQ(
      error_of(glb_of(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":0}]})", {0, 0, 0, 0})),
      kError);
}

// tinygltf's texts and exceptions never reach a reader.
TEST(GlbHostile, NamesTheDamagedPartAndTheCureInItsOwnWords) {
  const auto expect_part = [](const std::string& json, const std::string& part) {
    const std::string error = error_of(glb_of(json));
    EXPECT_EQ(error.find("damaged: " + part), 0u) << error;
    EXPECT_NE(error.find("; export it again"), error.npos) << error;
    for (const char* foreign : {"json.exception", "vector", "property", "\n", "\x1b", "evil"})
      EXPECT_EQ(error.find(foreign), error.npos) << error;
  };
  expect_part(R"({"asset":7})", "'asset'");
  expect_part(R"({"asset":{"version":"2.0"},"buffers":[{}]})", "'buffers'");
  expect_part(R"({"asset":{"version":"2.0"},"bufferViews":[7]})", "'bufferViews'");
  expect_part(R"({"asset":{"version":"2.0"},"accessors":[{"bufferView":"evil\u001b[2J"}]})", "");
  expect_part(R"({"asset":{"version":"2.0"},"nodes":[7]})", "'nodes'");
  expect_part(R"({"asset":{"version":"2.0"},"images":[{"name":"evil\u001b[2J"}]})", "'images'");
  expect_error(glb_of(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":8}],)"
                      R"("extensionsRequired":["KHR_mesh_quantization",)"
                      R"("EXT_meshopt_compression"]})"),
               "packed with EXT_meshopt_compression; export it without compression");
  expect_error(glb_of(R"({"asset":{"version":"2.0"}, "nodes":[)"),
               "damaged: its JSON breaks off or is no JSON; copy the file again");
}

TEST(GlbHostile, SaysWhatIsNoGltfAtAll) {
  expect_error({}, "no glTF file");
  expect_error({'g', 'l', 'T', 'F'}, "shorter than a GLB's header");
  expect_error({'H', 'I', 'E', 'R'}, "no glTF file");
  Bytes old = glb_of("{}");
  old[4] = 1;
  expect_error(old, "version 1");
  Bytes lying = glb_of("{}");
  lying[10] = 0x7f;
  expect_error(lying, "its header says");
  Bytes long_json = glb_of("{}");
  long_json[14] = 0x7f;
  expect_error(long_json, "no JSON at its beginning");
}

TEST(GlbHostile, AHumanIsNeededAndMotion) {
  expect_error(glb_of(R"({"asset":{"version":"2.0"}})"), "no nodes");
  expect_error(glb_of(R"({"asset":{"version":"2.0"},"nodes":[{}]})"), "no animation");
  expect_error(moving(kView, kTimes, kValues), "no human figure");
}

TEST(GlbHostile, RefusesNodesThatAreNoTree) {
  expect_error(moving(kView, kTimes, kValues, R"([{"children":[1]},{"children":[0]}])"),
               "below themselves");
  expect_error(moving(kView, kTimes, kValues, R"([{"children":[0]}])"), "below themselves");
  expect_error(moving(kView, kTimes, kValues, R"([{"children":[1,1]},{}])"), "two parents");
  expect_error(moving(kView, kTimes, kValues, R"([{"children":[7]}])"), "not in the file");
  expect_error(moving(kView, kTimes, kValues, R"([{"children":[-2]}])"), "not in the file");
  std::string chain = "[";
  for (int n = 0; n < 300; ++n) chain += R"({"children":[)" + std::to_string(n + 1) + "]},";
  expect_error(moving(kView, kTimes, kValues, chain + "{}]"), "nested too deeply");
  GlbLimits few;
  few.nodes = 2;
  expect_error(moving(kView, kTimes, kValues, "[{},{},{}]"), "more than 2 nodes", few);
  expect_error(moving(kView, kTimes, kValues, R"([{"translation":[1e300,0,0]}])"),
               "broken numbers");
  expect_error(moving(kView, kTimes, kValues, R"([{"rotation":[0,0,0,0]}])"), "length 0");
}

TEST(GlbHostile, RefusesNumbersOutsideTheirBuffers) {
  const auto times = [](const std::string& count, const std::string& more = "") {
    return R"({"bufferView":0,"componentType":5126,"count":)" + count + R"(,"type":"SCALAR")" +
           more + "}";
  };
  expect_error(moving(R"({"buffer":0,"byteLength":65})", kTimes, kValues), "beyond its buffer");
  expect_error(moving(R"({"buffer":0,"byteOffset":64,"byteLength":4})", kTimes, kValues),
               "beyond its buffer");
  expect_error(moving(R"({"buffer":5,"byteLength":64})", kTimes, kValues), "no buffer");
  expect_error(moving(kView, times("17"), kValues), "beyond its buffer view");
  expect_error(moving(kView, times("2147483647"), kValues), "too many numbers");
  expect_error(moving(kView, times("4294967296"), kValues), "");
  expect_error(moving(kView, times("0"), kValues), "empty");
  expect_error(moving(kView, times("2", R"(,"byteOffset":64)"), kValues), "beyond its buffer view");
  expect_error(moving(kView, times("2", R"(,"byteOffset":18446744073709551615)"), kValues), "");
  expect_error(moving(R"({"buffer":0,"byteLength":64,"byteStride":252})", kTimes, kValues),
               "beyond its buffer view");
  expect_error(moving(kView, kTimes,
                      R"({"bufferView":0,"componentType":5126,"count":2,"type":"VEC3",
                          "sparse":{"count":1,"indices":{"bufferView":0,"componentType":5123},
                          "values":{"bufferView":0}}})"),
               "sparse");
  expect_error(
      moving(kView, kTimes, R"({"bufferView":0,"componentType":5126,"count":2,"type":"MAT4"})"),
      "another type");
  expect_error(moving(kView, kTimes, R"({"componentType":5126,"count":2,"type":"VEC3"})"),
               "no buffer view");
  expect_error(
      moving(kView, kTimes, R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})"),
      "one value for each key");
}

TEST(GlbHostile, ManyAnimationsOverOneAccessorHaveOneBudgetOfNumbers) {
  const auto with_animations = [](int count) {
    std::string animations;
    for (int a = 0; a < count; ++a)
      animations += std::string(a > 0 ? "," : "") +
                    R"({"samplers":[{"input":0,"output":1}],)"
                    R"("channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]})";
    return glb_of(R"({"asset":{"version":"2.0"},"nodes":[{"name":"hips"}],)"
                  R"("buffers":[{"byteLength":64}],"bufferViews":[)" +
                      std::string(kView) + R"(],"accessors":[)" + kTimes + "," + kValues +
                      R"(],"animations":[)" + animations + "]}",
                  floats(16));
  };
  GlbLimits few;
  few.values = 8 * 60;  // two times and two places for each animation
  expect_error(with_animations(60), "no human figure", few);
  expect_error(with_animations(61), "too many numbers", few);
}

TEST(GlbHostile, RefusesNumbersThatAreNoMotion) {
  Bytes bin = floats(16);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bin.data() + 8, &nan, sizeof nan);
  expect_error(moving(kView, kTimes, kValues, "[{}]", bin), "not finite");
  Bytes backwards = floats(16);
  std::memset(backwards.data() + 4, 0, 4);
  expect_error(moving(kView, kTimes, kValues, "[{}]", backwards), "do not increase");
}

TEST(GlbHostile, OpensNoOtherFile) {
  for (const char* uri : {"/etc/hostname", "file:///etc/hostname", "../secret.bin", "dance.bin"})
    expect_error(
        glb_of(R"({"asset":{"version":"2.0"},"nodes":[{}],"buffers":[{"byteLength":4,"uri":")" +
               std::string(uri) + R"("}]})"),
        "which is not opened");
  // A picture that is not there is no reason to refuse a dance.
  expect_error(
      glb_of(R"({"asset":{"version":"2.0"},"nodes":[{}],"images":[{"uri":"/etc/hostname"}]})"),
      "no animation");
}

TEST(GlbHostile, RefusesJsonThatWouldExhaustTheParser) {
  std::string deep = R"({"asset":{"version":"2.0"},"extras":)";
  for (int i = 0; i < 100'000; ++i) deep += '[';
  expect_error(glb_of(deep), "nested too deeply");
  std::string many = R"({"asset":{"version":"2.0"},"nodes":[{})";
  for (int i = 0; i < 100'000; ++i) many += ",{}";
  expect_error(glb_of(many + "]}"), "too many objects");
  // Brackets in text are none.
  expect_error(glb_of(R"({"asset":{"version":"2.0","generator":"[[[[\"{{{"},"nodes":[{}]})"),
               "no animation");
}

TEST(GlbHostile, SaysThatAPackedAnimationIsNotRead) {
  expect_error(glb_of(R"({"asset":{"version":"2.0"},"nodes":[{}],)"
                      R"("extensionsUsed":["EXT_meshopt_compression"]})"),
               "without compression");
}

TEST(GlbHostile, EveryPrefixAndEveryFlippedBitIsReadOrRefused) {
  GlbOptions options;
  options.has_bodies = false;
  const auto whole = write_glb({random_dance("alice", 5, 9, false)}, options);
  ASSERT_TRUE(whole.has_value());
  for (std::size_t size = 0; size < whole->size(); size += 13)
    EXPECT_FALSE(read_glb(std::span(*whole).first(size)).has_value()) << size << " bytes";
  Bytes damaged = *whole;
  for (std::size_t bit = 0; bit < damaged.size() * 8; bit += 29) {
    const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
    damaged[bit / 8] ^= mask;
    if (const auto clips = read_glb(damaged); clips)
      for (const NamedClip& named : *clips) {
        EXPECT_TRUE(is_valid(named.clip.skeleton));
        for (const Pose& pose : named.clip.frames) EXPECT_TRUE(is_valid(pose));
      }
    damaged[bit / 8] ^= mask;
  }
}

}  // namespace
}  // namespace dance
