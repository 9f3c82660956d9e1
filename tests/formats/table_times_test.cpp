// Time columns, as numbers and as clocks show them.
#include "moclean/formats/table_times.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "formats/table_text.hpp"

namespace moclean {
namespace {

using test::table;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

void expect_clock(std::string_view text, std::int64_t seconds, double fraction, bool has_date) {
  const auto time = clock_time(text);
  ASSERT_TRUE(time.has_value()) << text;
  EXPECT_EQ(time->seconds, seconds) << text;
  EXPECT_NEAR(time->fraction, fraction, 1e-12) << text;
  EXPECT_EQ(time->has_date, has_date) << text;
}

TEST(ClockTimes, AreReadWithAndWithoutDateAndZone) {
  expect_clock("00:00:00", 0, 0, false);
  expect_clock("12:34:56.789", 45296, 0.789, false);
  expect_clock("9:05:00,25", 32700, 0.25, false);
  expect_clock("23:59:60", 86400, 0, false);  // a leap second
  expect_clock("5:01.25", 301, 0.25, false);
  expect_clock("1970-01-02T00:00:01Z", 86401, 0, true);
  expect_clock("2000-03-01 00:00:00", 951868800, 0, true);  // behind a leap day
  expect_clock("2024/05/01 12:00:00.5+02:00", 1714557600, 0.5, true);
  expect_clock("2024-05-01T12:00:00-0530", 1714584600, 0, true);
  expect_clock("2024-05-01T12:00:00+0030", 1714563000, 0, true);
  expect_clock("2024-05-01T12:00:00.000001 UTC", 1714564800, 1e-6, true);
}

TEST(ClockTimes, AreNothingElse) {
  for (const char* text :
       {"", "12", "12.5", "12:34", "12:34:56:07", "12:34:56.", "1:2:3", "12:60:00", "25:00:00",
        "12:34:61", "2024-13-01 00:00:00", "2023-02-29 00:00:00", "2024-05-01", "a:bb:cc.5",
        "12:34:56.7x", "12:34:56+2", "15:26:46:12.02", "2024-05-01T5:01.25"})
    EXPECT_FALSE(clock_time(text)) << text;
}

TEST(TableTimes, OfAClockTellTheRate) {
  std::string day = "Time,a\n", dated = "a,timestamp\n", seconds = "t,a\n";
  for (int f = 0; f < 50; ++f) {
    const int ms = 20 * f;
    day += fmt::format("23:59:{:02}.{:03},1\n", 58 + ms / 1000, ms % 1000);
    dated += fmt::format("1,2024-05-01T12:34:{:02}.{:03}Z\n", 56 + ms / 1000, ms % 1000);
    seconds += fmt::format("12:00:{:02},1\n", f);
  }

  EXPECT_EQ(table(day).frame_rate, 50);
  EXPECT_EQ(table(dated).frame_rate, 50);
  EXPECT_EQ(table(seconds).frame_rate, 1);
  EXPECT_EQ(table("time_ms,a\n00:00:00.00,1\n00:00:00.25,1\n").frame_rate, 4);
  EXPECT_EQ(table(day).notes.layout, "1 channel; no names tell of points; time in column 1, 50 Hz");
  EXPECT_EQ(test::written_again(table(dated)), dated);
}

// At 360 and 400 Hz whole milliseconds are 2 or 3 apart.
TEST(TableTimes, OfFewDigitsTellTheRateOfAllSteps) {
  for (const double rate : {240., 360., 400., 500.}) {
    std::string text = "time,a\n";
    for (int f = 0; f < 900; ++f) text += fmt::format("{:.3f},1\n", f / rate);

    EXPECT_NEAR(table(text).frame_rate, rate, 1e-3 * rate) << rate;
  }
}

TEST(TableTimes, OfAClockGoOnBehindMidnight) {
  const Recording recording =
      table("clock;A.x;A.y\n23:59:59,75;1;2\n00:00:00,00;1,5;2\n00:00:00,25;2;3\n");

  EXPECT_EQ(recording.frame_rate, 4);
  EXPECT_EQ(recording.samples(1, 0), 1.5);
}

TEST(TableTimes, OfAClockThatAreNoneOrGoBackAreRefusedByLine) {
  const auto failure = [](const char* text, const std::string& message) {
    EXPECT_THAT([&] { table(text); }, ThrowsMessage<FileError>(HasSubstr(message))) << text;
  };

  failure("Time,a\n12:00:01,1\n12:00:00,1\n",
          "tiny.csv:3: expected a time after 12:00:01, found 12:00:00 in column 1 ('Time')");
  failure("Time,a\n12:00:01,1\nlater,1\n", "tiny.csv:3: expected a number, found 'later'");
  failure("Time,a\n12:00:01,1\n0.5,1\n", "tiny.csv:3: expected a number, found '0.5'");
  failure("Time,a\n0.5,1\n12:00:01,1\n", "tiny.csv:3: expected a number, found '12:00:01'");
  failure("Time,a\n12:00:01,1\n,1\n",
          "tiny.csv:3: expected a time in column 1 ('Time'), found none");
}

// A clock of whole minutes, or with numbers of pictures behind the seconds, is text.
TEST(TableTimes, OfOtherSpellingPassThrough) {
  const Recording recording = table("Time,A.x,A.y\n15:26:46:12,1,2\n15:26:46:13,1,2\n");

  EXPECT_EQ(recording.frame_rate, 0);
  EXPECT_THAT(recording.notes.passed_through, ElementsAre("Time"));
}

TEST(TableTimes, MayStandStillInOneFrameOfAHundred) {
  const auto text = [](int frames) {
    std::string rows = "time,a\n";
    for (int f = 0; f < frames; ++f) rows += fmt::format("{:.2f},1\n", 0.01 * f);
    return rows + fmt::format("{:.2f},1\n", 0.01 * (frames - 1));
  };

  const Recording recording = table(text(99));

  EXPECT_EQ(recording.frames(), 100);
  EXPECT_EQ(recording.frame_rate, 100);
  EXPECT_THAT(recording.notes.warnings, ElementsAre("1 frame has the time of the one before"));
  EXPECT_THAT([&] { table(text(98)); },
              ThrowsMessage<FileError>(HasSubstr("tiny.csv:100: expected a time after 0.97")));
}

}  // namespace
}  // namespace moclean
