#include "tests/fuzz_target.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "tests/field_mutation.h"

namespace dance {
namespace {

// Constant-initialised: targets of other sources register before and after this one is initialised.
constinit const FuzzTarget* first_target = nullptr;

}  // namespace

FuzzTarget::FuzzTarget(const char* name, Run run) : name_(name), run_(run), next_(first_target) {
  first_target = this;
}

FuzzTarget::Run FuzzTarget::find(std::string_view name) {
  for (const FuzzTarget* target = first_target; target; target = target->next_)
    if (name == target->name_) return target->run_;
  std::fputs("give the name of a fuzz target:", stderr);
  for (const FuzzTarget* target = first_target; target; target = target->next_)
    std::fprintf(stderr, " %s", target->name_);
  std::fputs("\n", stderr);
  std::exit(2);
}

}  // namespace dance

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const dance::FuzzTarget::Run run = [] {
    const char* name = std::getenv("DANCE_FUZZ_TARGET");  // NOLINT(concurrency-mt-unsafe)
    return dance::FuzzTarget::find(name ? name : "");
  }();
  return run(data, size);
}

#ifdef DANCE_LIBFUZZER
// libFuzzer's interface: half of the inputs come from its own mutations, half from ours.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  dance::Random random(seed);
  if (random.below(2) == 0) return LLVMFuzzerMutate(data, size, most);
  const std::vector<std::uint8_t> mutated = dance::with_field_mutated({data, size}, random);
  size = std::min(mutated.size(), most);
  if (size > 0) std::memcpy(data, mutated.data(), size);
  return size;
}
#endif
