// Every parameter of every step at the ends of what it can be: refused by its name, or an answer in
// numbers, soon.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "contract/cleaner.hpp"

namespace moclean::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

// The keys of a step, as the message to an unknown one lists them.
std::vector<std::string> keys_of(const std::string& step) {
  std::string list;
  try {
    parse_chain(step + ":no-such-key=1");
  } catch (const ArgumentError& error) {
    constexpr std::string_view before = "expected one of ";
    list = error.what();
    const std::size_t begin = list.find(before);
    if (begin == std::string::npos) return {};
    list = list.substr(begin + before.size());
  }
  if (list.empty()) return {};  // a step without parameters
  std::vector<std::string> keys;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(", ", begin), list.size());
    keys.push_back(list.substr(begin, end - begin));
    begin = end + 2;
  }
  return keys;
}

std::vector<std::string> values() {
  std::istringstream words(
      "0 1 -1 2 3 0.5 1.01 9999 1e-300 1e-100 1e-9 1e6 1e9 1e10 1e12 1e100 1e300 1e308 1e309 "
      "nan inf -inf 2147483647 2147483648 9223372036854775807 9223372036854775808 "
      "18446744073709551616 -9223372036854775808 1x 0x10 on off velocity acceleration soft hard "
      "linear cubic pchip gentle auto equal");
  std::vector<std::string> all(std::istream_iterator<std::string>(words), {});
  all.insert(all.end(), {"", " 1"});
  return all;
}

// Few iterations are enough to make NaN.
std::string with_few_iterations(const std::string& chain, const std::vector<std::string>& keys) {
  const bool may = std::ranges::count(keys, "max-iterations") > 0 &&
                   chain.find("max-iterations") == std::string::npos;
  return may ? chain + ",max-iterations=40" : chain;
}

class ParameterExtremes : public ::testing::TestWithParam<Cleaner> {};

TEST_P(ParameterExtremes, AreRefusedByNameOrAnswered) {
  const auto& [step, backend] = GetParam();
  Recording take = noisy_limbs(40, 3);
  take.samples(20, 4) = std::numeric_limits<double>::quiet_NaN();
  if (!accepts_missing(parse_chain(step))) take = noisy_limbs(40, 3);
  const std::vector<std::string> keys = keys_of(step);
  int answered = 0;
  for (const std::string& key : keys)
    for (const std::string& value : values()) {
      const Cleaner cleaner{with_few_iterations(fmt::format("{}:{}={}", step, key, value), keys),
                            backend};
      SCOPED_TRACE(cleaner.chain);
      try {
        const Matrix motion = cleaner.motion(take);
        ++answered;
        for (Index i = 0; i < motion.size(); ++i)
          EXPECT_TRUE(std::isfinite(motion.data()[i]) || std::isnan(take.samples.data()[i]))
              << "sample " << i;
      } catch (const Error& error) {
        // svt has no rule for the segments of one or two frames that a key may ask for.
        EXPECT_THAT(error.what(), AnyOf(HasSubstr(key), HasSubstr("svt has no rule")));
      }
    }
  EXPECT_GE(answered, static_cast<int>(keys.size()));
}

INSTANTIATE_TEST_SUITE_P(Of, ParameterExtremes, ::testing::ValuesIn(every_cleaner()),
                         [](const auto& test) { return name_of(test.param); });

}  // namespace
}  // namespace moclean::test
