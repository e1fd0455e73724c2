#include "tests/report/browser.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <vtkBase64Utilities.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

namespace mimetra::test {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

/// Generous: it draws without a graphics card, beside other tests.
constexpr std::chrono::seconds kPatience{120};

// Where Chromium reads and writes with --remote-debugging-pipe.
constexpr int kBrowserReads = 3, kBrowserWrites = 4;

std::array<int, 2> pipe_ends() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  // Away from the numbers that the browser wants.
  for (int& end : ends) {
    const int moved = fcntl(end, F_DUPFD_CLOEXEC, 10);
    close(end);
    end = moved;
  }
  return ends;
}

[[noreturn]] void become(const std::vector<std::string>& words, int reads, int writes) {
  setpgid(0, 0);
  const int nothing = open("/dev/null", O_RDWR);
  for (const int standard : {0, 1, 2}) dup2(nothing, standard);
  dup2(reads, kBrowserReads);
  dup2(writes, kBrowserWrites);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments.front(), arguments.data());
  _exit(127);
}

Image decoded(const std::string& base64) {
  std::vector<unsigned char> bytes(base64.size());
  bytes.resize(
      vtkBase64Utilities::DecodeSafely(reinterpret_cast<const unsigned char*>(base64.data()),
                                       base64.size(), bytes.data(), bytes.size()));
  vtkNew<vtkPNGReader> reader;
  reader->SetMemoryBuffer(bytes.data());
  reader->SetMemoryBufferLength(static_cast<vtkIdType>(bytes.size()));
  reader->Update();
  vtkImageData& data = *reader->GetOutput();
  Image image(data.GetDimensions()[0], data.GetDimensions()[1]);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto* pixel = static_cast<unsigned char*>(
          data.GetScalarPointer(x, image.height - 1 - y, 0));  // VTK counts from below
      image.at(x, y) = {pixel[0], pixel[1], pixel[2]};
    }
  }
  return image;
}

}  // namespace

std::filesystem::path Browser::program() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const auto file = std::filesystem::path(folder) / "chromium";
    if (access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

Browser::Browser(int width, int height, bool phone) {
  const auto requests = pipe_ends(), answers = pipe_ends();
  std::vector<std::string> words = {program().string(),
                                    "--headless=new",
                                    "--remote-debugging-pipe",
                                    "--disable-dev-shm-usage",
                                    "--use-angle=swiftshader",
                                    "--enable-unsafe-swiftshader",
                                    "--user-data-dir=" + profile_.path().string(),
                                    "about:blank"};
  // Chromium's sandbox refuses to run as root.
  if (geteuid() == 0) words.insert(words.begin() + 1, "--no-sandbox");
  process_ = fork();
  if (process_ == 0) become(words, requests[0], answers[1]);
  close(requests[0]);
  close(answers[1]);
  to_browser_ = requests[1];
  from_browser_ = answers[0];

  const json target = call("Target.createTarget", {{"url", "about:blank"}}).at("targetId");
  session_ = call("Target.attachToTarget", {{"targetId", target}, {"flatten", true}})
                 .at("sessionId")
                 .get<std::string>();
  for (const char* domain : {"Page", "Runtime", "Log", "Network"}) {
    call(std::string(domain) + ".enable");
  }
  call("Emulation.setDeviceMetricsOverride", {{"width", width},
                                              {"height", height},
                                              {"deviceScaleFactor", phone ? 2 : 1},
                                              {"mobile", phone}});
}

Browser::~Browser() {
  close(to_browser_);
  close(from_browser_);
  if (process_ > 0) {
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
}

nlohmann::json Browser::next_message() {
  const auto end = Clock::now() + kPatience;
  while (true) {
    if (const auto stop = received_.find('\0'); stop != std::string::npos) {
      json message = json::parse(received_.substr(0, stop));
      received_.erase(0, stop + 1);
      return message;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    pollfd waiting{from_browser_, POLLIN, 0};
    if (left.count() <= 0 || poll(&waiting, 1, static_cast<int>(left.count())) <= 0) {
      throw std::runtime_error("the browser does not answer");
    }
    std::array<char, 65536> buffer{};
    const ssize_t count = read(from_browser_, buffer.data(), buffer.size());
    if (count <= 0) throw std::runtime_error("the browser has ended");
    received_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

void Browser::note(const nlohmann::json& event) {
  const std::string method = event.value("method", "");
  const json parameters = event.value("params", json::object());
  if (method == "Runtime.exceptionThrown" || method == "Log.entryAdded") {
    complaints_.push_back(parameters.dump());
  } else if (method == "Runtime.consoleAPICalled") {
    const std::string type = parameters.value("type", "");
    if (type == "error" || type == "warning" || type == "assert") {
      complaints_.push_back(parameters.dump());
    }
  } else if (method == "Network.requestWillBeSent") {
    const json& request = parameters.at("request");
    const auto address = request.at("url").get<std::string>();
    if (!address.starts_with("data:") && parameters.value("type", "") != "Document") {
      complaints_.push_back("request for " + address);
    }
  }
}

nlohmann::json Browser::call(const std::string& method, const nlohmann::json& parameters) {
  json request = {{"id", ++calls_}, {"method", method}};
  if (!parameters.is_null()) request["params"] = parameters;
  if (!session_.empty()) request["sessionId"] = session_;
  const std::string text = request.dump() + '\0';
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = write(to_browser_, text.data() + sent, text.size() - sent);
    if (count <= 0) throw std::runtime_error("the browser does not listen");
    sent += static_cast<std::size_t>(count);
  }
  while (true) {
    json message = next_message();
    if (message.value("id", 0) != calls_) {
      note(message);
      continue;
    }
    if (message.contains("error")) {
      throw std::runtime_error(method + ": " + message["error"].dump());
    }
    return message.at("result");
  }
}

void Browser::open(const std::filesystem::path& page) {
  // The page before may still be there.
  const std::string address = "file://" + std::filesystem::absolute(page).string();
  call("Page.navigate", {{"url", address}});
  wait_until("decodeURI(location.href) === " + json(address).dump() +
             " && document.readyState === 'complete'");
}

nlohmann::json Browser::value(const std::string& expression) {
  const json result =
      call("Runtime.evaluate",
           {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (result.contains("exceptionDetails")) {
    throw std::runtime_error(expression + ": " + result["exceptionDetails"].dump());
  }
  return result.at("result").value("value", json());
}

void Browser::wait_until(const std::string& expression) {
  const auto end = Clock::now() + kPatience;
  while (value(expression) != true) {
    if (Clock::now() > end) throw std::runtime_error("never became true: " + expression);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

PageBox Browser::box_of(const std::string& id) {
  const json box = value("(() => { const box = document.getElementById('" + id +
                         "').getBoundingClientRect();"
                         "return [box.x + scrollX, box.y + scrollY, box.width, box.height]; })()");
  return {box.at(0), box.at(1), box.at(2), box.at(3)};
}

void Browser::mouse(const char* type, double x, double y) {
  call("Input.dispatchMouseEvent",
       {{"type", type}, {"x", x}, {"y", y}, {"button", "left"}, {"buttons", 1}, {"clickCount", 1}});
}

void Browser::click(const std::string& id, double share) {
  value("document.getElementById('" + id + "').scrollIntoView({block: 'center'})");
  const PageBox box = box_of(id);
  const double top = box.top - value("scrollY").get<double>();
  const double x = box.left + share * box.width, y = top + box.height / 2;
  mouse("mousePressed", x, y);
  mouse("mouseReleased", x, y);
}

void Browser::drag(const std::string& id, double right, double down) {
  value("document.getElementById('" + id + "').scrollIntoView({block: 'center'})");
  const PageBox box = box_of(id);
  const double x = box.left + box.width / 4;
  const double y = box.top - value("scrollY").get<double>() + box.height / 2;
  mouse("mouseMoved", x, y);
  mouse("mousePressed", x, y);
  constexpr int kSteps = 5;
  for (int i = 1; i <= kSteps; ++i) {
    mouse("mouseMoved", x + right * i / kSteps, y + down * i / kSteps);
  }
  mouse("mouseReleased", x + right, y + down);
}

Image Browser::picture(const PageBox& box) {
  // What was drawn last is on the screen two frames later.
  value(
      "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
      ".then(() => true)");
  const json clip = {
      {"x", box.left}, {"y", box.top}, {"width", box.width}, {"height", box.height}, {"scale", 1}};
  const json result =
      call("Page.captureScreenshot", {{"clip", clip}, {"captureBeyondViewport", true}});
  return decoded(result.at("data").get<std::string>());
}

}  // namespace mimetra::test
