#include "cli/batch/manifest.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/core/hash.hpp"
#include "moclean/core/printable.hpp"
#include "moclean/core/version.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/temporary_name.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

// One line; the same for the same values. Bytes that are not UTF-8 are replaced.
std::string line_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// A name as text that JSON can hold, whatever its bytes are: \xNN stands for what is no UTF-8 or
// controls a terminal, and for a backslash. path_of() is the way back.
std::string name_text(const fs::path& name) {
  std::string text;
  for (const char letter : name.string()) {
    if (letter == '\\' || letter == '\n')
      text += fmt::format("\\x{:02X}", static_cast<unsigned>(letter));
    else
      text += letter;
  }
  return printable(text);
}

fs::path path_of(const std::string& text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = 0;
    const char* const digits = text.data() + i + 2;
    if (text.compare(i, 2, "\\x") == 0 && i + 4 <= text.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      name += static_cast<char>(byte);
      i += 3;
    } else {
      name += text[i];
    }
  }
  return name;
}

// Of the content of a regular file; empty for others.
std::string hash_of(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return "";
  std::ifstream stream(file, std::ios::binary);
  Fnv1a hash;
  char chunk[1 << 16];
  while (stream.read(chunk, sizeof chunk), stream.gcount() > 0)
    hash.bytes({chunk, static_cast<std::size_t>(stream.gcount())});
  return stream.bad() ? "" : fmt::format("{:016x}", hash.value());
}

// Whatever links lead to the folder it is in.
fs::path real_place(const fs::path& file) {
  return fs::weakly_canonical(file.parent_path()) / file.filename();
}

fs::path absolute_plain(const fs::path& path) { return fs::absolute(path).lexically_normal(); }

bool is_manifest_line(const Json& line) {
  return line.is_object() && line.contains("output") && line["output"].is_string() &&
         line.contains("outputs") && line["outputs"].is_object() && line.contains("input") &&
         line["input"].is_string();
}

}  // namespace

Manifest::Manifest(fs::path root) : root_(absolute_plain(root / "")), file_(root / manifest_name) {
  read();
}

void Manifest::read() {
  std::error_code error;
  if (!fs::is_regular_file(file_, error)) return;
  const std::string text = read_file(file_);
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != text.npos; begin = end + 1) {
    Json line = Json::parse(text.substr(begin, end - begin), nullptr, false);
    if (!is_manifest_line(line)) continue;
    const auto output = line["output"].get<std::string>();
    lines_[output] = std::move(line);
  }
}

// Below the folder of results wherever it is.
std::string Manifest::name_of(const fs::path& file) const {
  return name_text(absolute_plain(file).lexically_relative(root_));
}

const Json* Manifest::line_of(const std::string& output) const {
  const auto line = lines_.find(output);
  return line == lines_.end() ? nullptr : &line->second;
}

bool Manifest::is_done(const ManifestTake& take) const {
  const Json* line = line_of(name_of(take.outputs.front()));
  if (!line || line->value("version", "") != version()) return false;
  const Json& outputs = (*line)["outputs"];
  if (line_text((*line)["parameters"]) != line_text(take.parameters)) return false;
  if (outputs.size() != take.outputs.size()) return false;
  bool replaced = false;
  for (const fs::path& file : take.outputs) {
    const std::string name = name_of(file);
    std::error_code error;
    if (!outputs.contains(name) || outputs[name] != hash_of(file)) return false;
    replaced = replaced || fs::equivalent(file, take.input, error);
  }
  const std::string hash = hash_of(take.input);
  return replaced || (!hash.empty() && (*line)["input_hash"] == hash);
}

bool Manifest::is_result(const fs::path& file) const {
  const std::string name = name_of(file);
  const Json* line = line_of(name);
  return line && (*line)["outputs"].contains(name) && (*line)["outputs"][name] == hash_of(file);
}

void Manifest::add(const ManifestTake& take, const std::vector<CompleteFile>& files) {
  const std::string output = name_of(take.outputs.front());
  Json line;
  line["output"] = output;
  line["input"] = name_text(absolute_plain(take.file));
  line["input_hash"] = hash_of(take.input);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(take.input, error);
  line["input_size"] = error ? Json(nullptr) : Json(size);
  line["version"] = version();
  line["parameters"] = take.parameters;
  line["outputs"] = Json::object();
  for (const fs::path& file : take.outputs) {  // all but an input kept by an earlier run are new
    const auto complete = std::ranges::find(files, file, &CompleteFile::target);
    line["outputs"][name_of(file)] = hash_of(complete == files.end() ? file : complete->temporary);
  }

  const std::lock_guard lock(mutex_);
  if (!log_) log_ = std::make_unique<LineLog>(file_);
  log_->append(line_text(line));
  lines_[output] = std::move(line);
}

void Manifest::tidy() {
  log_.reset();
  read();
  if (lines_.empty()) return;
  AtomicFile file(file_);
  for (const auto& [output, line] : lines_) file.write(line_text(line) + "\n");
  file.commit();
}

std::vector<fs::path> Manifest::sides() const {
  std::vector<fs::path> files;
  for (const auto& [output, line] : lines_)
    for (const auto& [name, hash] : line["outputs"].items())
      if (name != output) files.push_back((root_ / path_of(name)).lexically_normal());
  return files;
}

std::vector<fs::path> Manifest::results_below(const fs::path& inputs) const {
  const fs::path folder = fs::weakly_canonical(inputs);
  std::vector<fs::path> files;
  for (const auto& [output, line] : lines_) {
    const fs::path result = (root_ / path_of(output)).lexically_normal();
    const fs::path input = real_place(path_of(line["input"].get<std::string>()));
    const fs::path below = input.lexically_relative(folder);
    if (input != real_place(result) && !below.empty() && *below.begin() != "..")
      files.push_back(result);
  }
  return files;
}

FolderLock::FolderLock(const fs::path& folder)
    : folder_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (folder_ >= 0) flock(folder_, LOCK_SH);
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) close(folder_);
}

// Another that waits for its turn gets it in between: a lock cannot be made stronger in one step.
void FolderLock::if_alone(const std::function<void()>& work) const {
  if (folder_ < 0 || flock(folder_, LOCK_EX | LOCK_NB) != 0) {
    if (folder_ >= 0) flock(folder_, LOCK_SH);
    return;
  }
  work();
  flock(folder_, LOCK_SH);
}

void remove_left_of(const std::vector<fs::path>& files) {
  std::map<fs::path, std::vector<std::string>> names;  // per folder
  for (const fs::path& file : files)
    names[file.has_parent_path() ? file.parent_path() : fs::path(".")].push_back(
        file.filename().string());
  for (const auto& [folder, targets] : names) {
    std::vector<fs::path> left;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
      if (entry->path().extension() == ".tmp" &&
          std::ranges::any_of(targets, [&](const std::string& target) {
            return is_temporary_of(entry->path(), target);
          }))
        left.push_back(entry->path());
    for (const fs::path& file : left) fs::remove(file, error);
    remove_left_in(folder);
  }
}

}  // namespace moclean::cli
