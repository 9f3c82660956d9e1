#include "moclean/core/hash.hpp"

#include <gtest/gtest.h>

namespace moclean {
namespace {

// Values of the authors' test suite (draft-eastlake-fnv).
TEST(Fnv1a, IsThatOfItsAuthors) {
  EXPECT_EQ(Fnv1a().value(), 0xcbf29ce484222325U);
  EXPECT_EQ(Fnv1a().bytes("a").value(), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(Fnv1a().bytes("foobar").value(), 0x85944171f73967e8U);
}

TEST(Fnv1a, TellsWhereATextEnds) {
  EXPECT_NE(Fnv1a().text("a").text("bc").value(), Fnv1a().text("ab").text("c").value());
}

TEST(Fnv1a, TakesTheBytesOfAWordFromTheLowestOn) {
  EXPECT_EQ(Fnv1a().word(0x0807060504030201U).value(), Fnv1a().bytes("\1\2\3\4\5\6\7\b").value());
}

}  // namespace
}  // namespace moclean
