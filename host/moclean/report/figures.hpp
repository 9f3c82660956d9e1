#pragma once

#include <optional>
#include <string>
#include <vector>

#include "moclean/report/report.hpp"

namespace moclean {

/// Two figures of the same kind, of the noisy and of the clean take.
struct BeforeAfter {
  double noisy = 0;
  double clean = 0;
};

/// What a report says about a take in numbers, in the unit of its clips. NaN entries take part in
/// none of them; a figure over no entry is 0.
struct ReportFigures {
  struct JointFigure {
    std::string name;
    double correction = 0;             ///< root mean square of E over the joint's columns
    std::optional<BeforeAfter> error;  ///< root mean square difference from the truth
  };

  /// A frame that is worse than those around it, before cleaning or after.
  struct WorstFrame {
    Index frame = 0;
    Index joint = 0;        ///< the worst joint of the frame, index into `joints`
    double correction = 0;  ///< |E| of that joint there (Euclidean)
  };

  double rms_correction = 0;  ///< of E over all entries
  /// Without ReportTake::status an entry counts as corrected if |E| exceeds this: a tenth of
  /// rms_correction. Robust PCA moves most entries by far less, and filters move all. 0 with it.
  double threshold = 0;
  Index corrected = 0;         ///< entries
  Index filled = 0;            ///< entries that were missing and are no more
  Index left = 0;              ///< entries that are missing
  Index corrected_frames = 0;  ///< frames with such an entry
  Index observed = 0;          ///< entries that are not NaN

  std::optional<BeforeAfter> fd;  ///< from the truth: Peng et al., equation (8)
  Index nearer_frames = 0;        ///< frames whose difference from the truth became less
  Index nearer_joints = 0;        ///< joints of which the same is true
  BeforeAfter roughness;          ///< root mean square second difference, per frame squared

  std::vector<JointFigure> joints;       ///< in the order of joints(noisy)
  std::vector<WorstFrame> worst_frames;  ///< worst first, at most five, apart from each other
  /// Where to look first: the frame that gained most, by the truth, else the worst one, and its
  /// joint. Frame -1: nothing was taken away.
  WorstFrame opening{.frame = -1};
  Matrix per_frame;  ///< root mean square per frame [frames x 1 or 3]: E; noisy - truth; clean -
                     ///< truth; NaN for a frame that is all gaps
};

/// Throws ShapeError unless the parts of the take are of one shape.
ReportFigures figures(const ReportTake& take);

/// Which entries count as corrected.
Mask corrected_entries(const ReportTake& take, double threshold);

/// |E| per frame and joint [frames x joints], Euclidean over the joint's columns; NaN where none of
/// them is observed.
Matrix joint_corrections(const Recording& outliers);

/// One or two sentences: whether the take got better, as far as that can be told.
std::string verdict(const ReportTake& take, const ReportFigures& figures);

}  // namespace moclean
