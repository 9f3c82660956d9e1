#include "moclean/run/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "moclean/backend/backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/core/usable.hpp"
#include "moclean/formats/amc.hpp"
#include "moclean/formats/find_skeleton.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/formats/tsv.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with('.') || name.starts_with('~');
}

// A text in a folder may be anything, a readme; only whoever names it says that it is a table.
bool is_looked_for(const Format& format) { return can_read(format) && &format != &txt_format; }

// `NAME.raw.EXT` beside a `NAME.EXT`.
bool is_kept_raw(const fs::path& file) {
  const fs::path stem = file.stem();
  std::error_code ignored;
  return stem.extension() == ".raw" &&
         fs::exists(file.parent_path() / (stem.stem() += file.extension()), ignored);
}

bool lies_in(const fs::path& inner, const fs::path& outer) {
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

// What has the name of a recording and is no file.
std::string kind_of(const fs::path& file) {
  std::error_code error;
  switch (fs::status(file, error).type()) {
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::block:
    case fs::file_type::character:
      return "a device";
    case fs::file_type::not_found:
      return "a link to nothing";
    default:
      return error ? error.message() : "no file";
  }
}

// Goes through folders; enters each once, by whatever name it comes to it.
class Walk {
 public:
  Walk(const LeavesOut& leave_out, PassedBy* passed) : leave_out_(leave_out), passed_(passed) {}

  // The recordings in a folder that are not among those of earlier folders.
  std::vector<fs::path> recordings_in(const fs::path& folder) {
    found_.clear();
    met_again_ = false;
    given_ = folder;
    std::vector<fs::path> links = {folder};
    while (!links.empty()) {  // those in a linked folder are followed after it
      std::vector<fs::path> deeper;
      for (const fs::path& link : links) enter(link, deeper);
      links = std::move(deeper);
    }
    if (found_.empty() && !met_again_ && (!passed_ || passed_->unreadable.empty()))
      throw FileError(folder, fmt::format("holds no recording ({})", any_extension(is_looked_for)));
    std::ranges::sort(found_);
    return std::move(found_);
  }

 private:
  // Real folders first: what is in them has the names by which people know it.
  void enter(const fs::path& folder, std::vector<fs::path>& links) {
    std::error_code error;
    const fs::path real = fs::canonical(folder, error);
    if (!error && !entered_.insert(real).second) {
      met_again_ = true;
      return;
    }
    std::vector<fs::path> inside;
    fs::directory_iterator entry, end;
    if (!error) entry = fs::directory_iterator(folder, error);
    for (; !error && entry != end; entry.increment(error)) inside.push_back(entry->path());
    if (error) pass_by(folder, error);
    std::ranges::sort(inside);
    for (const fs::path& path : inside) {
      if (is_hidden(path) || (leave_out_ && leave_out_(path))) continue;
      if (!fs::is_directory(path, error))
        add(path);
      else if (!fs::is_symlink(path))
        enter(path, links);
      else if (!lies_in(real, fs::weakly_canonical(path, error)))  // else it leads back
        links.push_back(path);
    }
  }

  void add(const fs::path& file) {
    if (!is_of_format(file, is_looked_for) || is_kept_raw(file)) return;
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored))
      found_.push_back(file);
    else if (passed_)
      passed_->skipped.push_back(fmt::format("{}: skipped, {}", file.string(), kind_of(file)));
  }

  void pass_by(const fs::path& folder, const std::error_code& error) {
    const FileError problem(folder, "cannot be read: " + error.message());
    if (!passed_ || folder == given_) throw problem;
    passed_->unreadable.push_back(folder);
    passed_->problems.emplace_back(problem.what());
  }

  const LeavesOut& leave_out_;
  PassedBy* passed_;  // null: a folder that cannot be read ends the walk
  fs::path given_;
  std::set<fs::path> entered_;
  bool met_again_ = false;  // a folder that was entered before
  std::vector<fs::path> found_;
};

// A link is a file of its own; the folder it is in may have many names.
fs::path place_of(const fs::path& file) {
  return fs::weakly_canonical(file.has_parent_path() ? file.parent_path() : fs::path(".")) /
         file.filename();
}

}  // namespace

std::vector<fs::path> expand_folders(const std::vector<fs::path>& inputs,
                                     const LeavesOut& leave_out, PassedBy* passed) {
  Walk walk(leave_out, passed);
  std::vector<fs::path> files;
  std::set<fs::path> places;
  const auto add = [&](const fs::path& file) {
    if (places.insert(place_of(file)).second) files.push_back(file);
  };
  for (const fs::path& input : inputs) {
    std::error_code error;
    const fs::file_status there = fs::status(input, error);
    if (there.type() == fs::file_type::not_found)
      throw FileError(input, "there is no such file or folder");
    if (!fs::exists(there)) throw FileError(input, "cannot be read: " + error.message());
    if (!fs::is_directory(there)) {
      add(input);
      continue;
    }
    for (const fs::path& file : walk.recordings_in(input)) add(file);
  }
  return files;
}

fs::path raw_name(const fs::path& input) { return (input.stem() += ".raw") += input.extension(); }

std::optional<fs::path> skeleton_of(const fs::path& file, const fs::path& given) {
  if (format_of(file) != &amc_format) return std::nullopt;
  if (!given.empty()) return given;
  try {
    return find_skeleton(file);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

// The solvers refuse such samples, too, but know neither the file nor the frame in it.
void require_solvable(const Recording& recording, const fs::path& file, const FrameRange& frames,
                      const InputNeeds& needs) {
  if (!needs.frame_rate_for.empty() && !(recording.frame_rate > 0))
    throw FileError(file, fmt::format("states no frame rate, which {} needs; give --rate HZ",
                                      needs.frame_rate_for));
  if (recording.samples.size() == 0) throw FileError(file, "holds no samples");
  const auto place = first_unusable(recording.samples, !needs.every_sample, largest_entry);
  if (!place) return;
  const double sample = recording.samples(place->frame, place->column);
  throw FileError(
      file, fmt::format("frame {}, column {} is {}; {}", frames.first.value_or(0) + place->frame,
                        recording.columns[static_cast<std::size_t>(place->column)], sample,
                        std::isnan(sample) ? "missing samples are not supported by this method"
                                           : "expected a number of sensible size"));
}

}  // namespace moclean
