#include "moclean/run/byte_size.hpp"

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/run/process_memory.hpp"

namespace moclean {
namespace {

std::uint64_t parse(const std::string& text) { return parse_byte_size("--memory-limit", text); }

TEST(ByteSize, SuffixesArePowersOf1024) {
  EXPECT_EQ(parse("1"), 1u);
  EXPECT_EQ(parse("512B"), 512u);
  EXPECT_EQ(parse("3K"), 3072u);
  EXPECT_EQ(parse("64M"), 67108864u);
  EXPECT_EQ(parse("2G"), 2147483648u);
  EXPECT_EQ(parse("1T"), 1099511627776u);
}

TEST(ByteSize, AcceptsFractionsAndOtherSpellingsOfTheSuffix) {
  EXPECT_EQ(parse("1.5K"), 1536u);
  EXPECT_EQ(parse("1.0009765625k"), 1025u);
  for (const char* text : {"1m", "1MB", "1MiB", "1mib"}) EXPECT_EQ(parse(text), 1048576u) << text;
}

TEST(ByteSize, RefusesEverythingElse) {
  for (const char* text : {"", "M", "0", "-1M", "0.1", "1e3", "1 M", "1Q", "1MK", "1MM", "1BB",
                           "nan", "inf", "1i", "99999999T", "1,5G"})
    EXPECT_THROW(parse(text), ArgumentError) << text;
}

TEST(ByteSize, NamesTheOptionAndWhatItExpects) {
  EXPECT_THAT([] { parse("lots"); },
              ::testing::ThrowsMessage<ArgumentError>(
                  "--memory-limit is 'lots', expected a number of bytes such as 512M or 2G"));
}

TEST(ByteSize, IsShownWithTheLargestUnitBelowIt) {
  EXPECT_EQ(byte_text(0), "0 B");
  EXPECT_EQ(byte_text(1023), "1023 B");
  EXPECT_EQ(byte_text(1024), "1 KiB");
  EXPECT_EQ(byte_text(1536 << 10), "1.5 MiB");
  EXPECT_EQ(byte_text(std::uint64_t{6} << 30), "6 GiB");
  EXPECT_EQ(byte_text(std::uint64_t{5} << 52), "2.048e+04 TiB");
}

TEST(ProcessMemory, TheProcessHasTakenSomeOfTheMachinesMemory) {
  EXPECT_GT(peak_memory(), 1u << 20);
  EXPECT_LT(peak_memory(), physical_memory());
}

}  // namespace
}  // namespace moclean
