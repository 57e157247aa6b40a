#include "base/size_text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "base/error.h"

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

TEST(SizeText, SizesAreReadWithTheirUnits) {
  EXPECT_EQ(bytesNamed("0", "--x"), 0u);
  EXPECT_EQ(bytesNamed("1234", "--x"), 1234u);
  EXPECT_EQ(bytesNamed("64K", "--x"), 65536u);
  EXPECT_EQ(bytesNamed("256M", "--x"), size_t{256} << 20);
  EXPECT_EQ(bytesNamed("3G", "--x"), size_t{3} << 30);
  for (const char* text :
       {"", "M", "-1", "1.5G", "10MB", "1 M", "12T", "99999999999999999999", "99999999999G"}) {
    try {
      bytesNamed(text, "--list-memory");
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.exitCode, ExitCode::Usage);
      EXPECT_TRUE(std::string(error.what()).starts_with("--list-memory"));
    }
  }
}

}  // namespace
}  // namespace sfumato::base
