#pragma once

#include <map>
#include <string>

#include "moclean/experiment/experiment.hpp"
#include "moclean/formats/line_log.hpp"

namespace moclean {

/// The finished cells of an experiment, kept in a file of JSON Lines so that a run that was killed
/// can be continued: one object per cell, `key` (cell_key()) and what CellResult has. Cells of
/// other experiments in the same file are left alone.
class CellResults {
 public:
  /// Reads what is there. Throws FileError naming file and line for a line that is no result.
  explicit CellResults(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return log_.file(); }

  /// Null if the cell is not finished.
  const CellResult* find(const std::string& key) const;

  /// Adds a finished cell, in the file first. Throws FileError.
  void keep(const std::string& key, const CellResult& result);

 private:
  LineLog log_;
  std::map<std::string, CellResult> results_;
};

}  // namespace moclean
