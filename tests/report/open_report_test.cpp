#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/report/browser.h"
#include "tests/report/report_fixture.h"
#include "toolkit/report/viewer_data.h"

namespace mimetra {
namespace {

using test::Browser;
using test::PageBox;
using testing::HasSubstr;
using testing::IsEmpty;

/// Share of pixels that are not white.
double drawn_share(const Image& image) {
  const auto drawn = std::ranges::count_if(image.pixels, [](const Color& color) {
    return color != Color{255, 255, 255};
  });
  return static_cast<double>(drawn) / static_cast<double>(image.pixels.size());
}

/// Share of pixels that differ so much that one sees it.
double changed_share(const Image& before, const Image& after) {
  constexpr int kVisible = 8;
  std::size_t changed = 0;
  for (std::size_t i = 0; i < before.pixels.size(); ++i) {
    changed += std::abs(before.pixels[i].green - after.pixels[i].green) > kVisible;
  }
  return static_cast<double>(changed) / static_cast<double>(before.pixels.size());
}

/// A report that is open in a browser.
class OpenReport : public testing::Test {
 protected:
  void SetUp() override {
    if (viewer_script().empty()) GTEST_SKIP() << "built without npm, reports have no viewer";
    if (Browser::program().empty()) GTEST_SKIP() << "no Chromium; ./dev hosts installs it";
  }
  static void TearDownTestSuite() { windows_.clear(); }

  /// Opens it anew in the window of this kind, and waits for its first picture.
  Browser& open(bool phone = false, const std::string& operation = "transfer") {
    std::ofstream(folder_ / "report.html") << page_of(operation);
    std::unique_ptr<Browser>& window = windows_[phone];
    if (!window) {
      window = phone ? std::make_unique<Browser>(390, 844, true)
                     : std::make_unique<Browser>(1280, 800, false);
    }
    browser_ = window.get();
    browser_->open(folder_ / "report.html");
    browser_->wait_until("document.getElementById('clock').textContent !== ''");
    return *browser_;
  }

  /// Made once for all tests.
  static const std::string& page_of(const std::string& operation) {
    static std::map<std::string, std::string> pages;
    std::string& page = pages[operation];
    if (page.empty()) {
      const RunRead run = test::run_of(operation, "actor", {{"k", std::int64_t{3}}});
      page = test::page_of(test::reported(run, {2}));
    }
    return page;
  }

  /// The stage, once it does not change any more.
  Image stage() {
    constexpr int kMostTries = 50;
    const PageBox box = browser_->box_of("stage");
    Image before = browser_->picture(box);
    for (int i = 0; i < kMostTries; ++i) {
      Image after = browser_->picture(box);
      if (after.pixels == before.pixels) return after;
      before = std::move(after);
    }
    throw std::runtime_error("the stage never stands still");
  }

  std::string clock() { return browser_->value("document.getElementById('clock').textContent"); }

  /// Chooses an entry of a list, as its change event tells the page.
  void choose(const std::string& list, const std::string& entry) {
    browser_->value("(() => { const list = document.getElementById('" + list +
                    "'); list.value = '" + entry +
                    "'; list.dispatchEvent(new Event('change')); })()");
  }

  test::TemporaryFolder folder_;
  Browser* browser_ = nullptr;
  /// By whether they are a phone's; starting one takes seconds.
  static inline std::map<bool, std::unique_ptr<Browser>> windows_;
};

TEST_F(OpenReport, DrawsItsMeshesWithoutAComplaint) {
  Browser& browser = open();
  EXPECT_GT(drawn_share(stage()), 0.1);
  // Source and target, each in a half of its own.
  PageBox half = browser.box_of("stage");
  half.width /= 2;
  EXPECT_GT(drawn_share(browser.picture(half)), 0.1);
  half.left += half.width;
  EXPECT_GT(drawn_share(browser.picture(half)), 0.1);
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST_F(OpenReport, ChangesItsPictureWithTheTimeSlider) {
  Browser& browser = open();
  const Image before = stage();
  browser.click("time", 0.5);
  EXPECT_GT(changed_share(before, stage()), 0.005);
  EXPECT_NEAR(std::stod(clock()), 0.48, 0.03);  // seconds; half of 23/24, and half the knob
  browser.click("time", 0.001);
  EXPECT_LT(changed_share(before, stage()), 0.001);
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST_F(OpenReport, PlaysAndPauses) {
  Browser& browser = open();
  browser.click("play");
  browser.wait_until("document.getElementById('clock').textContent !== '0.00 s'");
  EXPECT_EQ(browser.value("document.getElementById('play').textContent"), "Pause");
  browser.click("play");
  EXPECT_EQ(browser.value("document.getElementById('play').textContent"), "Play");
  stage();  // stands still
  const std::string paused = clock();
  stage();
  EXPECT_EQ(clock(), paused);
}

TEST_F(OpenReport, ShowsRegionsDisplacementOrNothing) {
  Browser& browser = open();
  browser.click("time", 0.3);
  const Image regions = stage();
  choose("coloring", "displacement");
  const Image displacement = stage();
  choose("coloring", "none");
  const Image none = stage();
  EXPECT_GT(changed_share(regions, displacement), 0.01);
  EXPECT_GT(changed_share(regions, none), 0.01);
  EXPECT_GT(changed_share(displacement, none), 0.01);
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST_F(OpenReport, NamesWhatIsClicked) {
  Browser& browser = open();
  const auto picked = [&browser] {
    return browser.value("document.getElementById('picked').textContent").get<std::string>();
  };
  browser.click("stage", 0.25);
  EXPECT_THAT(picked(), testing::MatchesRegex("source: (no region|region [0-9]+), vertex [0-9]+"));
  browser.click("stage", 0.75);
  EXPECT_THAT(picked(), HasSubstr("target: "));
  browser.click("stage", 0.002);
  EXPECT_EQ(picked(), "");
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST_F(OpenReport, HasALegendOfItsRegions) {
  Browser& browser = open();
  const std::string shown = "[...document.querySelectorAll('#legend span:not([hidden])')]";
  EXPECT_GT(browser.value(shown + ".length"), 1);
  EXPECT_EQ(browser.value(shown + "[0].textContent"), "0");
  EXPECT_EQ(browser.value("document.getElementById('legend').hidden"), false);
  choose("coloring", "displacement");
  EXPECT_EQ(browser.value("document.getElementById('legend').hidden"), true);
}

TEST_F(OpenReport, ShowsOneMeshInTheWholeStage) {
  Browser& browser = open();
  const double both = drawn_share(stage());
  choose("shown", "target");
  EXPECT_GT(drawn_share(stage()), 0.5 * both);
  EXPECT_EQ(browser.value("document.querySelector('[data-role=source]').hidden"), true);
  EXPECT_EQ(browser.value("document.querySelector('[data-role=target]').hidden"), false);
}

TEST_F(OpenReport, TurnsAndGoesBack) {
  Browser& browser = open();
  const Image before = stage();
  browser.drag("stage", 120, 30);
  EXPECT_GT(changed_share(before, stage()), 0.02);
  browser.click("reset");
  EXPECT_LT(changed_share(before, stage()), 0.001);
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST_F(OpenReport, TakesNoCommandsByKeys) {
  Browser& browser = open();
  const auto press = [&browser](const std::string& key) {
    browser.value(
        "document.querySelector('#stage canvas').dispatchEvent(new KeyboardEvent("
        "'keypress', {key: '" +
        key + "', bubbles: true}))");
  };
  const Image before = stage();
  for (const char* key : {"w", "v", "r"}) press(key);
  // Wireframe alone would change half of it.
  EXPECT_LT(changed_share(before, stage()), 0.1);
}

TEST_F(OpenReport, FitsAPhone) {
  Browser& browser = open(true);
  EXPECT_EQ(browser.value("document.documentElement.scrollWidth"), 390);
  const std::string beyond =
      "[...document.querySelectorAll('body *')].filter((element) => {"
      "  const box = element.getBoundingClientRect();"
      "  return box.width > 0 && (box.right > innerWidth + 0.5 || box.left < -0.5);"
      "}).map((element) => element.outerHTML.slice(0, 80))";
  EXPECT_THAT(browser.value(beyond), IsEmpty());
  EXPECT_GT(drawn_share(stage()), 0.1);
  const Image before = stage();
  browser.click("time", 0.5);
  EXPECT_GT(changed_share(before, stage()), 0.005);
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST_F(OpenReport, OfRegionsPlaysOneMesh) {
  Browser& browser = open(false, "regions");
  EXPECT_GT(drawn_share(stage()), 0.1);
  EXPECT_TRUE(browser.value("document.getElementById('shown')").is_null());
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

}  // namespace
}  // namespace mimetra
