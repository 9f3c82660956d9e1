#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

namespace moclean::test {

/// How the browser draws.
enum class Graphics { webgl, canvas_only };

/// A headless Chromium with one page, without network, spoken to by the DevTools protocol over a
/// pipe. Failures are those of the running test.
class Browser {
 public:
  /// Whether there is one.
  static bool installed();

  /// `width` and `height` are those of the page, in pixels; `profile` is a folder for its files.
  Browser(Graphics graphics, int width, int height, const std::filesystem::path& profile);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void set_colour_scheme(const std::string& scheme);  ///< "light" or "dark"

  /// Opens a file and waits until it is loaded.
  void open(const std::filesystem::path& file);

  /// The value of a JavaScript expression; of a promise, what it becomes.
  nlohmann::json evaluate(const std::string& expression);

  /// What went wrong on the page so far: exceptions, errors and warnings of the console.
  const std::vector<std::string>& problems() const { return problems_; }

  /// Everything the page has asked for by URL, itself first.
  const std::vector<std::string>& requests() const { return requests_; }

 private:
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters);
  nlohmann::json receive();
  void note(const nlohmann::json& event);

  pid_t process_ = 0;
  int to_ = -1;
  int from_ = -1;
  std::string received_;  // what is not read yet
  std::string session_;
  int calls_ = 0;
  bool loaded_ = false;
  std::vector<std::string> problems_;
  std::vector<std::string> requests_;
};

}  // namespace moclean::test
