#include "report/browser.hpp"

#include <array>
#include <csignal>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace moclean::test {
namespace {

using Json = nlohmann::json;

constexpr int patience = 120'000;  // milliseconds for one answer of a loaded machine

std::vector<std::string> arguments_of(Graphics graphics, const std::filesystem::path& profile) {
  std::vector<std::string> arguments = {MOCLEAN_CHROMIUM,
                                        "--headless",
                                        "--no-sandbox",
                                        "--disable-dev-shm-usage",
                                        "--no-first-run",
                                        "--remote-debugging-pipe",
                                        "--host-resolver-rules=MAP * ~NOTFOUND",
                                        "--user-data-dir=" + profile.string()};
  if (graphics == Graphics::webgl)
    arguments.insert(arguments.end(), {"--use-angle=swiftshader", "--enable-unsafe-swiftshader"});
  else
    arguments.insert(arguments.end(), {"--disable-gpu", "--disable-3d-apis"});
  return arguments;
}

// The browser reads commands from descriptor 3 and answers on 4.
[[noreturn]] void become_browser(int commands, int answers, std::vector<std::string> arguments) {
  setpgid(0, 0);
  const int high_commands = fcntl(commands, F_DUPFD, 10);  // out of the way of 3 and 4
  const int high_answers = fcntl(answers, F_DUPFD, 10);
  dup2(high_commands, 3);
  dup2(high_answers, 4);
  const int quiet = ::open("/dev/null", O_WRONLY);
  dup2(quiet, STDOUT_FILENO);
  dup2(quiet, STDERR_FILENO);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  execv(pointers[0], pointers.data());
  _exit(127);
}

std::string text_of(const Json& arguments) {
  std::string text;
  for (const Json& argument : arguments)
    text += argument.value("value", argument.value("description", Json())).dump() + " ";
  return text;
}

}  // namespace

bool Browser::installed() { return *MOCLEAN_CHROMIUM != '\0'; }

Browser::Browser(Graphics graphics, int width, int height, const std::filesystem::path& profile) {
  std::array<int, 2> commands{}, answers{};
  if (pipe2(commands.data(), O_CLOEXEC) != 0 || pipe2(answers.data(), O_CLOEXEC) != 0)
    throw std::runtime_error("no pipes");
  const std::vector<std::string> arguments = arguments_of(graphics, profile);
  process_ = fork();
  if (process_ == 0) become_browser(commands[0], answers[1], arguments);
  close(commands[0]);
  close(answers[1]);
  to_ = commands[1];
  from_ = answers[0];
  std::signal(SIGPIPE, SIG_IGN);  // a browser that does not start is an answer that does not come

  const Json target = call("Target.createTarget", {{"url", "about:blank"}});
  const Json attached =
      call("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}});
  session_ = attached["sessionId"];
  for (const char* domain : {"Page.enable", "Runtime.enable", "Log.enable", "Network.enable"})
    call(domain, Json::object());
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

Browser::~Browser() {
  close(to_);
  close(from_);
  kill(-process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

void Browser::set_colour_scheme(const std::string& scheme) {
  const Json feature = {{"name", "prefers-color-scheme"}, {"value", scheme}};
  call("Emulation.setEmulatedMedia", {{"features", Json::array({feature})}});
}

void Browser::open(const std::filesystem::path& file) {
  loaded_ = false;
  call("Page.navigate", {{"url", "file://" + file.string()}});
  while (!loaded_) note(receive());
}

Json Browser::evaluate(const std::string& expression) {
  const Json answer =
      call("Runtime.evaluate",
           {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
  if (answer.contains("exceptionDetails"))
    throw std::runtime_error(answer["exceptionDetails"].dump());
  return answer["result"].value("value", Json());
}

Json Browser::call(const std::string& method, const Json& parameters) {
  Json message = {{"id", ++calls_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump() + '\0';
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = write(to_, text.data() + sent, text.size() - sent);
    if (count <= 0) throw std::runtime_error("the browser does not listen");
    sent += static_cast<std::size_t>(count);
  }
  for (;;) {
    Json answer = receive();
    if (answer.value("id", 0) != calls_) {
      note(answer);
      continue;
    }
    if (answer.contains("error")) throw std::runtime_error(method + ": " + answer["error"].dump());
    return answer["result"];
  }
}

// The next message, an answer or an event.
Json Browser::receive() {
  std::size_t end = received_.find('\0');
  while (end == std::string::npos) {
    pollfd waiting{.fd = from_, .events = POLLIN, .revents = 0};
    std::array<char, 65536> block{};
    if (poll(&waiting, 1, patience) <= 0) throw std::runtime_error("the browser does not answer");
    const ssize_t count = read(from_, block.data(), block.size());
    if (count <= 0) throw std::runtime_error("the browser has ended");
    received_.append(block.data(), static_cast<std::size_t>(count));
    end = received_.find('\0');
  }
  Json message = Json::parse(received_.begin(), received_.begin() + static_cast<long>(end));
  received_.erase(0, end + 1);
  return message;
}

void Browser::note(const Json& event) {
  const std::string method = event.value("method", "");
  if (method == "Page.loadEventFired") loaded_ = true;
  if (method == "Runtime.exceptionThrown")
    problems_.push_back(event["params"]["exceptionDetails"].dump());
  if (method == "Log.entryAdded") problems_.push_back(event["params"]["entry"]["text"]);
  if (method == "Runtime.consoleAPICalled") problems_.push_back(text_of(event["params"]["args"]));
  if (method == "Network.requestWillBeSent") requests_.push_back(event["params"]["request"]["url"]);
}

}  // namespace moclean::test
