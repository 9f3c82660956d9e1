#include "moclean/core/specification.hpp"

#include <array>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/parameters.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::ThrowsMessage;

struct Cooking {
  enum class Heat { low, high };

  double salt = 0.5;
  Index eggs = 2;
  int minutes = 4;
  std::optional<double> pepper = {};
  Heat heat = Heat::low;

  bool operator==(const Cooking&) const = default;

  static constexpr std::string_view name = "cooking";
  static constexpr std::array<std::string_view, 2> heats = {"low", "high"};
  static void visit(auto& self, auto& visitor) {
    visitor("salt", self.salt);
    visitor("eggs", self.eggs);
    visitor("minutes", self.minutes);
    visitor("pepper", self.pepper);
    visitor("heat", self.heat, heats);
  }
};

void check(const Cooking& cooking) {
  if (cooking.eggs > 9) throw ArgumentError("too many eggs");
}

Cooking read(std::string_view text) { return read_parameters<Cooking>({"meal", text}); }

void expect_refused(std::string_view text, const std::string& message) {
  EXPECT_THAT([&] { read(text); }, ThrowsMessage<ArgumentError>(message)) << text;
}

TEST(SplitChain, CutsAtEveryPlusButThoseOfNumbers) {
  EXPECT_THAT(split_chain("a"), ElementsAre("a"));
  EXPECT_THAT(split_chain("a:x=1,y=2+b+c:z=3"), ElementsAre("a:x=1,y=2", "b", "c:z=3"));
  EXPECT_THAT(split_chain("a:x=1e+5+b:y=2"), ElementsAre("a:x=1e+5", "b:y=2"));
  EXPECT_THAT(split_chain("a++"), ElementsAre("a", "", ""));
  EXPECT_THAT(split_chain(""), ElementsAre(""));
}

TEST(Parameters, AreReadInAnyOrderOverTheDefaults) {
  EXPECT_EQ(read("cooking"), Cooking{});
  EXPECT_EQ(
      read("cooking:heat=high,salt=-1e-2,pepper=3,minutes=7,eggs=0"),
      (Cooking{
          .salt = -0.01, .eggs = 0, .minutes = 7, .pepper = 3.0, .heat = Cooking::Heat::high}));
}

TEST(Parameters, AreReadOverGivenValues) {
  const Cooking mine{.salt = 9, .eggs = 1};

  EXPECT_EQ(read_parameters<Cooking>({"meal", "cooking:eggs=3"}, mine),
            (Cooking{.salt = 9, .eggs = 3}));
}

TEST(Parameters, ReadBackWhatIsWritten) {
  const Cooking mine{.salt = 1.0 / 3, .pepper = 1e300, .heat = Cooking::Heat::high};

  EXPECT_EQ(read(to_specification(mine)), mine);
  EXPECT_EQ(to_specification(Cooking{}), "cooking:salt=0.5,eggs=2,minutes=4,heat=low");
}

TEST(Parameters, NameWhatIsWrongAndWhatWouldBeRight) {
  expect_refused("cooking:sugar=1",
                 "meal cooking: unknown key 'sugar', expected one of salt, eggs, minutes, pepper, "
                 "heat");
  expect_refused("cooking:eggs=1,eggs=2", "meal cooking: eggs is given twice");
  expect_refused("cooking:eggs", "meal cooking: expected key=value, found 'eggs'");
  expect_refused("cooking:salt=much", "meal cooking: salt is 'much', expected a number");
  expect_refused("cooking:eggs=1.5",
                 "meal cooking: eggs is '1.5', expected a whole number of at least 0");
  expect_refused("cooking:minutes=3000000000",
                 "cooking: minutes is 3000000000, which is too large");
  expect_refused("cooking:heat=mild", "meal cooking: heat is 'mild', expected one of low, high");
  expect_refused("cooking:eggs=10", "too many eggs");
}

TEST(Alternatives, AreFoundByName) {
  using Meal = std::variant<Cooking>;
  const auto read_any = []<class T>(const Specification& given, const T& value) {
    return read_parameters(given, value);
  };

  EXPECT_THAT(names_of<Meal>(), ElementsAre("cooking"));
  EXPECT_EQ(find_alternative<Meal>({"meal", "cooking:eggs=5"}, read_any), Meal(Cooking{.eggs = 5}));
  EXPECT_EQ(find_alternative<Meal>({"meal", "baking"}, read_any), std::nullopt);
  EXPECT_THAT([] { Specification("meal", "baking").throw_unknown(names_of<Meal>()); },
              ThrowsMessage<ArgumentError>("unknown meal 'baking', expected one of cooking"));
}

}  // namespace
}  // namespace moclean
