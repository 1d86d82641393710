// The fuzzer's corpus, and mutations of it, as ordinary tests.
#include <gtest/gtest.h>

#include "file_scratch.hpp"
#include "mutations.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace innersphere::test {
namespace {

void survives(const std::string& bytes) {
  EXPECT_EQ(LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), 0);
}

// The first byte stays: it names the format.
void feed(const char* input) {
  const std::string good = bytesOf(std::string(CORPUS_FOLDER) + "/" + input);
  feedMutations(good.substr(1), 1500, [&](const std::string& bytes) { survives(good[0] + bytes); });
}

TEST(FileCorpus, EveryInputIsSurvived) {
  std::size_t inputs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CORPUS_FOLDER)) {
    survives(bytesOf(entry.path().string()));
    ++inputs;
  }
  EXPECT_GE(inputs, 15u);
}

TEST(FileMutation, Json) {
  feed("planes_json");
}
TEST(FileMutation, Cbor) {
  feed("measures_cbor");
}
TEST(FileMutation, Xyzr) {
  feed("packing_xyzr");
}

}  // namespace
}  // namespace innersphere::test
