#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "moclean/denoise/denoiser.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// A take before and after cleaning.
struct ReportTake {
  Recording noisy;
  Recording clean = {};  ///< same shape and columns as `noisy`
  std::optional<Recording> truth =
      {};                   ///< same shape; the report then says whether the take got better
  Recording outliers = {};  ///< E, same shape: what was taken away; NaN where there is a gap
  std::optional<Matrix> status = {};  ///< of every sample, see status_numbers(); without it what
                                      ///< counts as corrected is told from E
  std::optional<Matrix> sigma = {};   ///< standard deviations of `clean`, drawn as a band
  std::vector<int> parents =
      {};  ///< per joint of joints(noisy): the joint it hangs on, -1 for a root;
           ///< empty: no skeleton, joints are drawn as a cloud of points
  std::vector<DenoisedSegment> segments = {};  ///< empty for methods without any
};

/// A table of results, for instance the ranking of methods by an experiment. A click on a column's
/// head sorts by it.
struct ReportTable {
  using Cell = std::variant<std::string, double>;  ///< NaN: no figure, shown as a dash

  std::string title;
  std::string note = {};                  ///< one or two sentences below the title; may be empty
  std::vector<std::string> columns = {};  ///< heads
  std::vector<std::vector<Cell>> rows = {};
};

/// What a report shows, in this order: verdict and figures, the player, curves, the heat map, the
/// segments, the tables, the parameters. All text may hold any characters.
struct Report {
  std::string title;                    ///< file name of the take, or name of the experiment
  std::optional<ReportTake> take = {};  ///< without one there are only tables and parameters
  std::vector<ReportTable> tables = {};
  std::vector<std::pair<std::string, std::string>> parameters = {};  ///< name and value
};

/// Whether the libraries of the page (three.js, dygraphs) were there when moclean was built.
bool report_available();

/// Throws Error that says what to install unless report_available().
void require_report();

/// The report as one HTML page that needs no other file and no network.
///
/// Samples are rounded to 16 bits of each column's range (quantised.hpp); a take of 10 000 frames
/// of 31 joints with its truth makes a page of about 10 MB. Takes time and memory of the order of
/// the page. Throws as require_report(), and ShapeError if the parts of a take, or the rows of a
/// table, do not fit together.
std::string html(const Report& report);

/// Copies of a take's samples that its text takes.
inline constexpr std::uint64_t copies_in_text = 4;

}  // namespace moclean
