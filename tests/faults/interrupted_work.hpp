#pragma once

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/batch_folder.hpp"

namespace moclean::test {

/// A command on files of a folder, whose results are what stands below `out` then.
struct InterruptedWork {
  std::string name;
  std::vector<std::string> command;  ///< `@` begins a path in the folder
};

/// Whether every signal is tried at every moment (MOCLEAN_SIGNALS=all).
inline bool all_signals() {
  const char* wanted = std::getenv("MOCLEAN_SIGNALS");
  return wanted && std::string_view(wanted) == "all";
}

/// A folder in which one command is run again and again, disturbed and not.
class Workshop {
 public:
  using Results = std::vector<std::pair<std::string, std::string>>;

  explicit Workshop(InterruptedWork work) : work_(std::move(work)) {
    std::filesystem::create_directory(folder_ / "tmp");
  }

  const TemporaryFolder& folder() const { return folder_; }
  const Results& whole() const { return whole_; }
  std::chrono::microseconds duration() const { return duration_; }

  /// What the command makes, found by two undisturbed runs: what differs in them states times.
  Outcome learn() {
    clear();
    const Outcome first = Program(command(), start()).wait();
    const Results before = results();
    clear();
    const auto begin = std::chrono::steady_clock::now();
    Program(command(), start()).wait();
    duration_ = std::chrono::duration_cast<std::chrono::microseconds>(
        std::chrono::steady_clock::now() - begin);
    whole_ = results();
    for (const auto& result : whole_)
      if (states_times(result.first) || std::ranges::find(before, result) == before.end())
        timed_.insert(result.first);
    return first;
  }

  void clear() const {
    std::filesystem::remove_all(folder_ / "out");
    std::filesystem::create_directory(folder_ / "out");
  }

  std::vector<std::string> command() const {
    std::vector<std::string> arguments = work_.command;
    for (std::string& argument : arguments)
      if (argument.starts_with('@')) argument = folder_ / argument.substr(1);
    return arguments;
  }

  Start start() const {
    return {.cache = folder_ / "out/cache", .environment = {"TMPDIR=" + (folder_ / "tmp")}};
  }

  Results results() const {
    Results all = contents_below(folder_, "out");
    // that a device was used before is noted for what is shown next time, and for nothing else
    std::erase_if(
        all, [](const auto& result) { return result.first.starts_with("cache/moclean/used-"); });
    return all;
  }

  /// The first of the results that is no complete one, with its place; empty if there is none. A
  /// list that grows by lines (`.jsonl`) may have fewer.
  std::string half_result(bool temporary_allowed) const {
    for (const auto& result : results()) {
      const auto& [name, bytes] = result;
      if (name.ends_with(".jsonl") || (temporary_allowed && name.ends_with(".tmp"))) continue;
      const auto same_name = [&](const auto& other) { return other.first == name; };
      const auto complete = std::ranges::find_if(whole_, same_name);
      if (complete == whole_.end()) return name + " is none of the results";
      if (!timed_.contains(name) && complete->second != bytes) return name + " is half";
      if (timed_.contains(name) && !is_closed(name, bytes)) return name + " is cut off";
    }
    return {};
  }

  /// What differs from an undisturbed run; empty if nothing does.
  std::string difference() const {
    const Results now = results();
    for (const auto& [name, bytes] : whole_) {
      const auto same_name = [&](const auto& other) { return other.first == name; };
      const auto found = std::ranges::find_if(now, same_name);
      if (found == now.end()) return name + " is missing";
      if (!timed_.contains(name) && found->second != bytes) return name + " differs";
    }
    if (now.size() != whole_.size())
      return "there is more: " + ::testing::PrintToString(names(now));
    return files_below(folder_, "tmp").empty() ? "" : "there are files in TMPDIR";
  }

 private:
  // In two short runs they may happen to be the same.
  static bool states_times(const std::string& name) {
    return name.ends_with(".html") || name.ends_with(".json");
  }

  static bool is_closed(const std::string& name, const std::string& bytes) {
    if (name.ends_with(".html")) return bytes.find("</html>") != bytes.npos;
    if (name.ends_with(".json")) return nlohmann::json::accept(bytes);
    return bytes.empty() || bytes.ends_with('\n');
  }

  static std::vector<std::string> names(const Results& results) {
    std::vector<std::string> all;
    for (const auto& result : results) all.push_back(result.first);
    return all;
  }

  InterruptedWork work_;
  TemporaryFolder folder_;
  Results whole_;
  std::set<std::string> timed_;
  std::chrono::microseconds duration_{};
};

}  // namespace moclean::test
