// The fuzzer's corpus as an ordinary test.
#include <gtest/gtest.h>

#include "file_scratch.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace innersphere::test {
namespace {

TEST(FileCorpus, EveryInputIsSurvived) {
  std::size_t inputs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CORPUS_FOLDER)) {
    const std::string bytes = bytesOf(entry.path().string());
    EXPECT_EQ(LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), 0);
    ++inputs;
  }
  EXPECT_GE(inputs, 15u);
}

}  // namespace
}  // namespace innersphere::test
