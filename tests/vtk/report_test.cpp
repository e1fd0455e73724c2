#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mimetra/vtk/report_page.h>
#include <mimetra/vtk/viewer_script.h>

#include "report_fixture.h"
#include "temporary_folder.h"

namespace mimetra {
namespace {

using nlohmann::json;
using test::message_of;
using test::page_of;
using test::reported;
using test::run_of;
using testing::HasSubstr;
using testing::Not;

/// One report for the tests that only look at it.
const Outcome& transfer_report() {
  static const Outcome outcome =
      reported(run_of("transfer", "<b>actor</b> & \"co\"", {{"k", std::int64_t{3}}}), {2, 3, 5}, {},
               {"gallery", "weights-plot", "table-plot"});
  return outcome;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t i = 0; (i = text.find(part, i)) != std::string::npos; ++i) ++count;
  return count;
}

/// What a page shows: all but its scripts.
std::string shown(const std::string& page) {
  std::string text = page;
  for (std::size_t i = 0; (i = text.find("<script", i)) != std::string::npos;) {
    text.erase(i, text.find("</script>", i) - i);
  }
  return text;
}

/// Pages are too long to be shown when they lack something.
bool holds(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

TEST(HtmlText, IsEscaped) {
  EXPECT_EQ(html_escaped("<a href=\"x\">'&'</a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
  EXPECT_EQ(html_escaped("Grüße"), "Grüße");
}

TEST(Report, IsBelowItsLimitAndSaysItsSize) {
  const std::string page = page_of(transfer_report());
  EXPECT_LT(page.size(), kLargestReport);
  EXPECT_EQ(json::parse(transfer_report().report).at("bytes"), page.size());
}

TEST(Report, AsksForNothingFromElsewhere) {
  const std::string page = page_of(transfer_report());
  EXPECT_FALSE(holds(page, "http://"));
  EXPECT_FALSE(holds(page, "https://"));
  EXPECT_TRUE(holds(page, "default-src 'none'"));
  const std::string elements = shown(page);
  EXPECT_EQ(count_of(elements, "src=\""), count_of(elements, "src=\"data:image/png;base64,"));
  EXPECT_EQ(count_of(elements, "srcset=\""), count_of(elements, "srcset=\"data:image/png;base64,"));
  EXPECT_EQ(count_of(elements, "href=\""), count_of(elements, "href=\"data:,\""));
}

TEST(Report, EscapesNames) {
  const std::string page = page_of(transfer_report());
  EXPECT_TRUE(holds(page, "<h1>bumps → b&gt; &amp; &quot;co&quot;</h1>"));
  EXPECT_TRUE(holds(page, "transfer takes/bumps &lt;b&gt;actor"));
  EXPECT_FALSE(holds(shown(page), "<b>"));
}

TEST(Report, HasTheRowsAskedForBesideTheRunsOwn) {
  const json rows = json::parse(transfer_report().report).at("rows");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].at("k"), 2);
  EXPECT_EQ(rows[1].at("k"), 3);
  EXPECT_EQ(rows[2].at("k"), 5);
  EXPECT_TRUE(rows[3].at("k").is_null());
  EXPECT_EQ(count_of(page_of(transfer_report()), "<tr class=\"main\"><td>3</td>"), 1u);
}

TEST(Report, HasTheRowsThatEvaluateHas) {
  const std::vector<std::int64_t> counts = {2, 3};
  const RunRead run = run_of("evaluate", "actor", {{"k", counts}});
  const OperationTable table = test::full_table();
  json expected = json::parse(table.find("evaluate")->run(*run.invocation).report).at("rows");
  const ReportStudy found = study({"run", run}, {2}, {}, {});
  json rows = json::parse(table_of(found.transfer->rows).json()).at("rows");
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const char* time : {"decompose_seconds", "transfer_seconds"}) {
      rows[i].erase(time);
      expected[i].erase(time);
    }
    EXPECT_EQ(rows[i], expected[i]);
  }
}

TEST(Report, ShowsComponentsAtWeightOneTheStrongestFirst) {
  const RunRead run = run_of("regions", "", {{"k", std::int64_t{3}}});
  const ReportStudy found = study({"run", run}, {2}, {}, {});
  const Sheet sheet = component_gallery(found, {.unit = "mm"}, 2);
  ASSERT_EQ(sheet.rows.size(), 2u);
  ASSERT_EQ(sheet.rows[1].tiles.size(), 1u);
  const Components& components = *found.components;
  const Eigen::VectorXd energy = motion_energy(components);
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const int component = found.regions.regions[static_cast<std::size_t>(i)].component;
    EXPECT_LE(energy[component], before);
    before = energy[component];
    const Tile& tile = sheet.rows[static_cast<std::size_t>(i / 2)].tiles[i % 2];
    EXPECT_TRUE(tile.title.starts_with(std::to_string(i + 1) + ": ")) << tile.title;
    EXPECT_TRUE(tile.title.ends_with(" mm")) << tile.title;
    const VertexIndex center = components.centers[static_cast<std::size_t>(component)];
    EXPECT_EQ(tile.colors[static_cast<std::size_t>(center)], even_color(1));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(
          tile.positions(center, axis),
          components.rest(center, axis) + components.displacements(component, 3 * center + axis));
    }
  }
}

TEST(Report, GivesItsPicturesAsFilesToo) {
  for (const char* name : {"gallery", "weights-plot", "table-plot"}) {
    const auto& picture = std::get<Image>(transfer_report().outputs.at(name).front().data);
    EXPECT_GT(picture.width, 200) << name;
    const auto is_dark = [](const Color& color) { return color.green < 128; };
    EXPECT_GT(std::ranges::count_if(picture.pixels, is_dark), 100) << name;
  }
}

TEST(Report, OfRegionsHasNoTargetAndNoTable) {
  const Outcome outcome = reported(run_of("regions", "", {{"k", std::int64_t{3}}}), {2});
  const std::string page = page_of(outcome);
  EXPECT_TRUE(holds(page, "<h1>bumps</h1>"));
  EXPECT_FALSE(holds(page, "<th>MPE"));
  EXPECT_TRUE(holds(page, "<h2>Components</h2>"));
  EXPECT_FALSE(json::parse(outcome.report).contains("rows"));
}

TEST(Report, RefusesATransferByAllTriangles) {
  const RunRead run = run_of("transfer", "actor", {{"full", true}});
  EXPECT_THAT(message_of<MismatchError>([&] { reported(run, {2}); }),
              HasSubstr("run/mimetra-run.json: was made with --full"));
}

TEST(Report, RefusesARunWithoutRegions) {
  const RunRead run = run_of("convert", "", {});
  EXPECT_THAT(message_of<MismatchError>([&] { reported(run, {2}); }),
              HasSubstr("a report shows what transfer, evaluate or regions wrote"));
}

TEST(Report, WarnsWhereTheInputsGiveSomethingElseNow) {
  RunRead run = run_of("transfer", "actor", {{"k", std::int64_t{2}}});
  std::vector<std::string> warnings;
  const Log log = [&warnings](LogLevel level, const std::string& message) {
    if (level == LogLevel::warning) warnings.push_back(message);
  };
  const auto study_after = [&run, &log](double error) {
    run.record.result = json{{"targets", {{{"name", "actor"}, {"de_all", error}}}}}.dump();
    return study({"run", run}, {2}, {}, log);
  };
  const auto changed = testing::Contains(HasSubstr("its inputs, or the program, have changed"));
  const double now = study({"run", run}, {2}, {}, {}).transfer->rows.front().de_all;
  study_after(now);
  EXPECT_THAT(warnings, Not(changed));
  study_after(1.01 * now + 1);
  EXPECT_THAT(warnings, changed);
}

TEST(Report, SaysWhyItHasNoViewer) {
  const RunRead run = run_of("transfer", "actor", {{"k", std::int64_t{3}}});
  const ReportStudy found = study({"run", run}, {3}, {}, {});
  const ReportPage page = report_page(found, {}, "", {});
  EXPECT_EQ(page.viewer_frames, 0);
  EXPECT_TRUE(holds(page.html, "No 3D viewer: this mimetra was built without npm."));
  EXPECT_FALSE(holds(page.html, "<script"));
}

TEST(Report, HasAllFramesInItsViewerWhereTheyFit) {
  if (viewer_script().empty()) GTEST_SKIP() << "built without npm";
  EXPECT_EQ(json::parse(transfer_report().report).at("viewer_frames"), 24);
  const std::string page = page_of(transfer_report());
  EXPECT_EQ(count_of(page, "<script>"), 1u);
  EXPECT_EQ(count_of(page, "</script>"), 2u);
}

}  // namespace
}  // namespace mimetra
