#include "cli/batch/standard_streams.hpp"

#include <algorithm>
#include <cstdio>
#include <system_error>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/temporary_name.hpp"
#include "moclean/formats/unfinished.hpp"

#include "cli/printing/standard_output.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
}

std::string standard_input() {
  const OutsideWait wait;
  std::string bytes;
  char chunk[1 << 16];
  for (std::size_t count; (count = std::fread(chunk, 1, sizeof chunk, stdin)) > 0;)
    bytes.append(chunk, count);
  if (std::ferror(stdin)) throw FileError("standard input", "cannot be read to its end");
  return bytes;
}

void require_alone(const DenoiseOptions& options) {
  if (options.inputs.size() > 1)
    throw ArgumentError("- is standard input and the only input where it is given");
  if (options.keep_raw) throw ArgumentError("--keep-raw needs an input that is a file, not -");
}

}  // namespace

// Delegates, so that the destructor removes the folder after a failure.
StandardStreams::StandardStreams(DenoiseOptions& options) : StandardStreams() {
  const bool reads = std::ranges::find(options.inputs, "-") != options.inputs.end();
  const bool writes = options.output == "-";
  if (reads) require_alone(options);
  const std::string input_format =
      options.input_format.empty() ? options.format : options.input_format;
  if (reads && input_format.empty())
    throw ArgumentError("standard input needs --input-format FORMAT, or --format for both");
  if (!reads && !options.input_format.empty())
    throw ArgumentError("--input-format is that of standard input, -");
  if (writes && options.format.empty() && !reads)
    throw ArgumentError("standard output needs --format FORMAT");
  if (writes && (options.inputs.size() > 1 || fs::is_directory(options.inputs.front())))
    throw ArgumentError("- as OUTPUT takes the result of one input");
  if (!reads && !writes) return;
  const std::string bytes = reads ? standard_input() : "";  // before anything is made: Ctrl-C
  folder_ = make_temporary_folder();
  if (writes) {
    if (options.format.empty()) options.format = input_format;
    output_ = folder_ / ("output." + options.format);
    options.output = output_;
  }
  if (reads) {
    input_ = folder_ / ("input." + input_format);
    AtomicFile file(input_);
    file.write(bytes);
    file.commit();
    options.inputs = {input_};
    options.input_format.clear();
  }
}

StandardStreams::~StandardStreams() {
  if (folder_.empty()) return;
  settle_unfinished(folder_, [&] {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  });
}

std::string StandardStreams::named(std::string text) const {
  if (!input_.empty()) replace_all(text, input_.string(), "standard input");
  if (!output_.empty()) replace_all(text, output_.string(), "standard output");
  return text;
}

// The folder goes first: whoever reads may close the pipe, which ends the program.
void StandardStreams::send() const {
  if (output_.empty()) return;
  const std::string bytes = read_file(output_);
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  write_output(bytes);
}

}  // namespace moclean::cli
