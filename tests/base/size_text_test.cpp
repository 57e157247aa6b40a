#include "base/size_text.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace sfumato::base {
namespace {

TEST(SizeText, TakesTheLargestUnitOfWhichThereIsOne) {
  EXPECT_EQ(sizeText(0), "0 bytes");
  EXPECT_EQ(sizeText(1023), "1023 bytes");
  EXPECT_EQ(sizeText(1024), "1.0 KiB");
  EXPECT_EQ(sizeText(size_t{65536}), "64.0 KiB");
  EXPECT_EQ(sizeText(size_t{1} << 20), "1.0 MiB");
  EXPECT_EQ(sizeText((size_t{1} << 20) - 1), "1.0 MiB");  // and not 1024.0 KiB
  EXPECT_EQ(sizeText(int64_t{3} << 29), "1.5 GiB");
  EXPECT_EQ(sizeText(size_t{5} << 40), "5120.0 GiB");
}

}  // namespace
}  // namespace sfumato::base
