#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/temporary_folder.h"
#include "toolkit/io/image.h"

namespace mimetra::test {

/// Pixels of the page, from its upper left corner.
struct PageBox {
  double left = 0;
  double top = 0;
  double width = 0;
  double height = 0;
};

/// Chromium without a window, spoken to over pipes in its DevTools protocol. What fails throws
/// std::runtime_error.
class Browser {
 public:
  /// Where chromium is installed; empty where it is not.
  static std::filesystem::path program();

  /// With a window of this size; `phone`: touched, and with two pixels for each of the page.
  Browser(int width, int height, bool phone);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens a file and waits until it is loaded.
  void open(const std::filesystem::path& page);
  /// Value of a JavaScript expression.
  nlohmann::json value(const std::string& expression);
  /// Waits until an expression is true.
  void wait_until(const std::string& expression);
  PageBox box_of(const std::string& id);
  /// Presses and releases the left button at a share of an element's width, in its middle height.
  void click(const std::string& id, double share = 0.5);
  /// Presses the button on one element and releases it `right` and `down` pixels from there.
  void drag(const std::string& id, double right, double down);
  /// What is seen of a part of the page.
  Image picture(const PageBox& box);
  /// What went wrong so far: console errors and warnings, exceptions, and every request besides
  /// those for the opened file and data in it.
  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters = nullptr);
  nlohmann::json next_message();
  void note(const nlohmann::json& event);
  void mouse(const char* type, double x, double y);

  TemporaryFolder profile_;
  int process_ = -1;
  int to_browser_ = -1;
  int from_browser_ = -1;
  int calls_ = 0;
  std::string session_;
  std::string received_;
  std::vector<std::string> complaints_;
};

}  // namespace mimetra::test
