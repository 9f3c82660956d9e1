// The fuzz targets without libFuzzer, over what they begin with: what scripts/fuzz runs for hours,
// in seconds.

#include <gtest/gtest.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/csv.hpp"

#include "fuzz/memory_use.hpp"
#include "fuzz/recordings.hpp"
#include "fuzz/seeds.hpp"
#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"
#include "support/data.hpp"

namespace moclean::fuzz {
namespace {

class FuzzTarget : public testing::TestWithParam<InputKind> {
 protected:
  // All of the input, and what is left of it when it is cut short.
  void expect_promises_kept(const Seed& seed) const {
    constexpr std::size_t cuts = 12;
    const std::string_view content = seed.content;
    for (std::size_t cut = 1; cut <= cuts; ++cut) {
      const std::size_t size = content.size() * cut / cuts;
      try {
        run_(content.substr(0, size));
      } catch (const Violation& violation) {
        ADD_FAILURE() << GetParam().target << ": the first " << size << " bytes of " << seed.name
                      << ": " << violation.what();
      }
    }
  }

 private:
  fuzz::Run run_ = target_named(GetParam().target);
};

TEST_P(FuzzTarget, KeepsItsPromisesForItsSeeds) {
  const std::vector<Seed> seeds = seeds_of(GetParam());
  ASSERT_FALSE(seeds.empty());

  for (const Seed& seed : seeds) expect_promises_kept(seed);
}

TEST_P(FuzzTarget, KeepsItsPromisesForTheCasesOfPeople) {
  const auto folder = std::filesystem::path(MOCLEAN_SOURCE_DIR).parent_path() / "shared" / "cases";
  MOCLEAN_REQUIRE_FILE(folder);

  for (const Seed& seed : seeds_below(folder, GetParam())) expect_promises_kept(seed);
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzTarget,
                         testing::ValuesIn(input_kinds().begin(), input_kinds().end()),
                         [](const auto& kind) { return std::string(kind.param.target); });

// What the harness says of parsers that break their promises.
TEST(FuzzHarness, NoticesForeignExceptionsAndMessagesThatCannotBeShown) {
  EXPECT_THROW(succeeds([] { throw std::out_of_range("at"); }), Violation);
  EXPECT_THROW(succeeds([] { throw std::bad_alloc(); }), Violation);
  EXPECT_THROW(succeeds([] { throw ArgumentError(""); }), Violation);
  EXPECT_FALSE(succeeds([] { throw ArgumentError("expected a number"); }));
  EXPECT_TRUE(succeeds([] {}));
}

Recording read_as(std::string_view content, const Matrix& samples) {
  return {.samples = samples,
          .columns = std::vector<std::string>(static_cast<std::size_t>(samples.cols()), "a"),
          .frame_rate = static_cast<double>(content.size()),
          .unit = ""};
}

TEST(FuzzHarness, NoticesRecordingsThatAreNone) {
  const auto of = [](auto read) { return Codec{.format = csv_format, .read = read}; };
  const auto is_violated = [](const Codec& codec) {
    try {
      return read_input(codec, "a,b\n1,2\n"), false;
    } catch (const Violation&) {
      return true;
    }
  };

  EXPECT_FALSE(is_violated(of(csv_format.read)));
  EXPECT_TRUE(is_violated(of([](std::string_view text, const auto&, const auto&) {
    return read_as(text, Matrix(0, 1));
  })));
  EXPECT_TRUE(is_violated(of([](std::string_view text, const auto&, const auto&) {
    return read_as(text, Matrix{{std::numeric_limits<double>::infinity()}});
  })));
}

TEST(FuzzHarness, NoticesWhatDoesNotComeBack) {
  const Codec shrinking{
      .format = csv_format,
      .read = [](std::string_view text, const std::filesystem::path&, const ReadOptions&) {
        return read_as(text, Matrix{{1, 2}});
      }};

  EXPECT_THROW(read_and_write(shrinking, "a,b\n1,2\n"), Violation);
  read_and_write({.format = csv_format, .read = csv_format.read}, "a,b\n1,2\n");
}

TEST(FuzzHarness, NoticesMemoryBeyondItsBound) {
  if (!sees_memory()) GTEST_SKIP() << "only AddressSanitizer tells what is allocated";
  const MemoryUse memory;
  void* volatile large = ::operator new(5000);  // which no compiler leaves out
  ::operator delete(large);

  EXPECT_THROW(memory.expect_within({.fixed = 1000, .per_byte = 10}, 100), Violation);
  memory.expect_within({.fixed = 1000, .per_byte = 1000}, 100);
}

}  // namespace
}  // namespace moclean::fuzz
