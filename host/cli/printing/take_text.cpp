#include "cli/printing/take_text.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/printable.hpp"
#include "moclean/denoise/sample_status.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

// Of names out of files, none of which ends it.
template <class... Values>
std::string line(fmt::format_string<Values...> format, Values&&... values) {
  return printable_line(fmt::format(format, std::forward<Values>(values)...)) + "\n";
}

// `7`, or `5-9` if the segments differ.
template <class Value>
std::string range(const std::vector<DenoisedSegment>& segments, const Value& value) {
  const auto [least, most] = std::ranges::minmax(segments, {}, value);
  return value(least) == value(most) ? fmt::format("{}", value(least))
                                     : fmt::format("{}-{}", value(least), value(most));
}

// What the segments say; nothing for filters.
std::string segments_text(const std::vector<DenoisedSegment>& segments) {
  if (segments.empty()) return "";
  const auto iterations = [](const DenoisedSegment& s) { return s.outcome.iterations; };
  const auto rank = [](const DenoisedSegment& s) { return s.outcome.rank.value_or(0); };
  const bool has_rank = std::ranges::all_of(
      segments, [](const DenoisedSegment& s) { return s.outcome.rank.has_value(); });
  return fmt::format(" segments {}, iterations {},{}", segments.size(), range(segments, iterations),
                     has_rank ? fmt::format(" rank {},", range(segments, rank)) : "");
}

// Two digits, but no fewer than the whole number has; `0 %` is none at all.
std::string share_text(double share) {
  const double percent = 100 * share;
  return percent >= 9.5 ? fmt::format("{:.0f} %", percent) : fmt::format("{:.2g} %", percent);
}

std::string share_text(Index part, Index whole) {
  return share_text(whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0);
}

std::string distance_text(const TakeReport& take) {
  const Change& changed = take.changed;
  std::string text =
      fmt::format("{:.3g}{}", changed.largest.distance, take.unit.empty() ? "" : " " + take.unit);
  if (changed.body_size > 0)
    text += fmt::format(" ({} of the body's size)", share_text(changed.largest_share()));
  return text;
}

std::string changes_text(const TakeReport& take) {
  std::string text = fmt::format("{} corrected, {} filled", share_text(take.changed.corrected),
                                 share_text(take.changed.filled));
  if (take.changed.largest.distance > 0)
    text += fmt::format(", largest change {} of {} in frame {}", distance_text(take),
                        take.changed.largest.joint, take.changed.largest.frame);
  return text;
}

Index count(const TakeReport& take, SampleStatus status) {
  return take.status[static_cast<std::size_t>(status)];
}

// Bodies differ in size and files in units: as shares of their body where they have one.
bool is_changed_more(const TakeReport& a, const TakeReport& b) {
  const auto sized = [](const TakeReport& take) { return take.changed.body_size > 0; };
  if (sized(a) != sized(b)) return sized(a);
  return sized(a) ? a.changed.largest_share() > b.changed.largest_share()
                  : a.changed.largest.distance > b.changed.largest.distance;
}

}  // namespace

std::string take_text(const TakeReport& take, const fs::path& result) {
  std::string text =
      line("{} -> {}: {} frames x {} columns,{} {:.3f} s, {:.0f} frames/s; {}", take.file.string(),
           result.string(), take.frames, take.columns, segments_text(take.segments),
           take.solve_seconds, take.frames_per_second(), changes_text(take));
  if (take.truth)
    text += line("{}: FD from the truth {:.4g} -> {:.4g}", take.file.string(), take.truth->fd_noisy,
                 take.truth->fd_clean);
  if (take.verification) text += line("{}", agreement_line(take));
  return text;
}

std::string run_text(const RunReport& run, const std::vector<char>& done_before) {
  Index done = 0, failed = 0, left_out = 0, samples = 0, corrected = 0, filled = 0;
  const TakeReport* most = nullptr;
  for (std::size_t i = 0; i < run.takes.size(); ++i) {
    const TakeReport& take = run.takes[i];
    if (done_before[i]) {
      ++left_out;
    } else if (!take.failure.empty()) {
      ++failed;
    } else {
      ++done;
      for (const Index number : take.status) samples += number;
      corrected += count(take, SampleStatus::corrected);
      filled += count(take, SampleStatus::filled);
      if (take.changed.largest.distance > 0 && (!most || is_changed_more(take, *most)))
        most = &take;
    }
  }
  std::string text = fmt::format(
      "takes    {} done, {} failed, {} left out (done before)\n"
      "samples  {} of {} corrected ({}), {} filled ({})\n",
      done, failed, left_out, corrected, samples, share_text(corrected, samples), filled,
      share_text(filled, samples));
  text += most
              ? line("largest  {}: {} of {} in frame {}", most->file.string(), distance_text(*most),
                     most->changed.largest.joint, most->changed.largest.frame)
              : "largest  nothing was moved\n";
  return text + fmt::format("seconds  {:.1f}\n", run.seconds.total);
}

}  // namespace moclean::cli
