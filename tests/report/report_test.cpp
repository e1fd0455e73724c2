#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/report/report_fixture.h"
#include "tests/temporary_folder.h"
#include "toolkit/correspondence/correspondence.h"
#include "toolkit/io/correspondence_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/reports.h"
#include "toolkit/report/report_page.h"
#include "toolkit/report/viewer_data.h"

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

/// What runs by three components find, computed once.
const ReportStudy& transfer_study() {
  static const ReportStudy found =
      study(test::named(run_of("transfer", "actor", {{"k", std::int64_t{3}}})), {2});
  return found;
}

const ReportStudy& regions_study() {
  static const ReportStudy found =
      study(test::named(run_of("regions", "", {{"k", std::int64_t{3}}})), {2});
  return found;
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

TEST(Markup, IsEscaped) {
  EXPECT_EQ(escaped_for_xml("<a href=\"x\">'&'</a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
  EXPECT_EQ(escaped_for_xml("Grüße"), "Grüße");
}

TEST(Report, IsOnePageBelowItsLimitThatAsksForNothingFromElsewhere) {
  const std::string page = page_of(transfer_report());
  EXPECT_LT(page.size(), kLargestReport);
  EXPECT_EQ(json::parse(transfer_report().report).at("bytes"), page.size());
  EXPECT_FALSE(holds(page, "http://"));
  EXPECT_FALSE(holds(page, "https://"));
  EXPECT_TRUE(holds(page, "default-src 'none'"));
  const std::string elements = shown(page);
  EXPECT_EQ(count_of(elements, "src=\""), count_of(elements, "src=\"data:image/png;base64,"));
  EXPECT_EQ(count_of(elements, "srcset=\""), count_of(elements, "srcset=\"data:image/png;base64,"));
  EXPECT_EQ(count_of(elements, "href=\""), count_of(elements, "href=\"data:,\""));
  if (viewer_script().empty()) return;
  EXPECT_EQ(json::parse(transfer_report().report).at("viewer_frames"), 24) << "all of them";
  EXPECT_EQ(count_of(page, "<script>"), 1u);
  EXPECT_EQ(count_of(page, "</script>"), 2u);
}

TEST(Report, EscapesNames) {
  const std::string page = page_of(transfer_report());
  EXPECT_TRUE(holds(page, "<h1>bumps → b&gt; &amp; &quot;co&quot;</h1>"));
  EXPECT_TRUE(holds(page, "transfer takes/bumps &#39;&lt;b&gt;actor"));
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
  json expected = json::parse(table.find("evaluate")->run(run.invocation).report).at("rows");
  const ReportStudy found = study(test::named(run), {2});
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

TEST(Report, ShowsEveryComponentAtWeightOneTheStrongestFirst) {
  // More components than bumps: several share a centre, and so a region.
  const RunRead run = run_of("regions", "", {{"k", std::int64_t{5}}});
  const ReportStudy found = study(test::named(run), {2});
  const Components& components = *found.components;
  const Eigen::VectorXd energy = motion_energy(components);
  const std::vector<int> order = strongest_components(components, 100);
  EXPECT_EQ(static_cast<Eigen::Index>(order.size()), (energy.array() > 0).count());
  EXPECT_GT(order.size(), found.regions.regions.size());
  const Sheet sheet = component_gallery(components, order, {.unit = "mm"}, 2);
  ASSERT_EQ(sheet.rows.size(), (order.size() + 1) / 2);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int k = order[i];
    EXPECT_LE(energy[k], energy[order[i > 0 ? i - 1 : 0]]);
    const Tile& tile = sheet.rows[i / 2].tiles[i % 2];
    EXPECT_TRUE(tile.title.starts_with(std::to_string(k) + ": ")) << tile.title;
    EXPECT_TRUE(tile.title.ends_with(" mm")) << tile.title;
    const VertexIndex center = components.centers[static_cast<std::size_t>(k)];
    EXPECT_EQ(tile.colors[static_cast<std::size_t>(center)], even_color(1));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(tile.positions(center, axis),
                components.rest(center, axis) + components.displacements(k, 3 * center + axis));
    }
  }
  EXPECT_EQ(strongest_components(components, 2).size(), 2u);
}

TEST(Report, ShowsATargetOfAnotherUnitAtTheSourcesSize) {
  const ReportStudy metres =
      study(test::named(run_of("transfer", "actor", {{"k", std::int64_t{3}}}, 1e-3)), {});
  const MeshSequence& shown = metres.transfer->by_regions;
  EXPECT_NEAR(shown.diameter(), metres.sequence.diameter(), 1e-9 * shown.diameter());
  EXPECT_NEAR(metres.transfer->full.diameter(), shown.diameter(), 1e-9 * shown.diameter());
  // The target is 1.2 times as large in one direction.
  const double scale = metres.transfer->shown_scale;
  EXPECT_GT(scale, 1000 / 1.2);
  EXPECT_LT(scale, 1000);
  EXPECT_TRUE(
      holds(report_page(metres, {}, "").html,
            "The target is shown " + std::to_string(std::lround(scale)) + " times its size"));
  const ReportStudy alike =
      study(test::named(run_of("transfer", "actor", {{"k", std::int64_t{3}}}, 0.8)), {});
  EXPECT_EQ(alike.transfer->shown_scale, 1);
  EXPECT_FALSE(holds(report_page(alike, {}, "").html, "times its size"));
}

TEST(Report, ShowsATargetOfOtherFaces) {
  test::Shape coarse = test::grid(9, 9);  // over the source's 15 x 15 vertices
  coarse.positions *= 14.0 / 8;
  const TriMesh target = test::mesh_of(coarse);
  const MeshSequence take = test::bumpy_take();
  const SurfaceFit lying{take.rest(), std::vector<bool>(225, true), std::vector<bool>(81, true)};
  const test::TemporaryFolder folder;
  std::ofstream(folder / "pairs.json") << correspondence_json(
      pair_triangles(lying, take.triangles(), target), take.connectivity(), target.connectivity);
  RunRead run =
      run_of("transfer", "actor",
             {{"k", std::int64_t{3}}, {"correspondence", (folder / "pairs.json").string()}});
  const BlendshapeModel mesh(std::make_shared<Connectivity>(target.connectivity), coarse.positions,
                             {{}, Eigen::MatrixXd(243, 0)});
  run.invocation.inputs["target"] = {{"actor", ModelData{MorphableModel(mesh)}}};
  const ReportStudy shown = study(test::named(run), {});
  EXPECT_EQ(shown.transfer->by_regions.vertices(), 81);
  ASSERT_EQ(shown.transfer->regions_of_vertices.size(), 81u);
  EXPECT_GE(std::ranges::max(shown.transfer->regions_of_vertices), 0);
  EXPECT_FALSE(report_page(shown, {}, "").html.empty());
}

TEST(Report, OfAnEvaluatedPaintingHasItsRowsOnly) {
  const test::TemporaryFolder folder;
  std::string list;
  for (int v = 0; v < 225; ++v) list += v < 75 ? "1\n" : "0\n";
  std::ofstream(folder / "w.txt") << list;
  const RunRead run =
      run_of("evaluate", "actor", {{"paint", (folder / "w.txt").string()}, {"falloff", "0.2"}});
  const ReportStudy found = study(test::named(run), {});
  const std::vector<EvaluationRow>& rows = found.transfer->rows;
  ASSERT_EQ(rows.size(), 2U);
  // Five rows of vertices are painted, and the border reaches beyond.
  EXPECT_GT(found.regions.triangle_share(), 6.0 / 14);
  EXPECT_EQ(found.regions.triangle_share(), rows[0].triangle_share);
}

TEST(Report, SaysWhyItHasNoViewer) {
  const ReportPage page = report_page(transfer_study(), {}, "");
  EXPECT_EQ(page.viewer_frames, 0);
  EXPECT_TRUE(holds(page.html, "No 3D viewer: this mimetra was built without npm."));
  EXPECT_FALSE(holds(page.html, "<script"));
}

TEST(Report, KeepsAnyLimit) {
  const ReportStudy& found = transfer_study();
  const std::string viewer(1000, ' ');
  const ReportPage free = report_page(found, {}, viewer);
  ASSERT_EQ(free.viewer_frames, 24);
  const std::size_t limit = free.html.size() * 7 / 10;
  const ReportPage kept = report_page(found, {}, viewer, limit);
  EXPECT_LT(kept.html.size(), limit);
  EXPECT_GE(kept.viewer_frames, 2);
}

TEST(Report, NamesComponentsAsFilesDo) {
  const ReportStudy& found = regions_study();
  const std::string page = report_page(found, {}, "").html;
  const Region& first = found.regions.regions.front();
  EXPECT_TRUE(holds(page, "<tr><td>0</td><td>" + std::to_string(first.component) + "</td><td>" +
                              std::to_string(first.center) + "</td>"));
  EXPECT_EQ(weight_charts(found).front().series.front().name,
            "component " + std::to_string(first.component));
}

TEST(Report, ShowsWeightsWithoutComponents) {
  const RunRead searched = run_of("transfer", "actor", {{"k", std::int64_t{3}}});
  Invocation call = searched.invocation;
  call.inputs["regions"] = {{"rois", RegionData{transfer_study().regions, {}}}};
  const RunRead given{searched.record, std::move(call)};
  const std::string page = page_of(reported(given, {2}));
  EXPECT_FALSE(holds(page, "<h2>Components</h2>"));
  EXPECT_TRUE(holds(page, "<h2>Weights</h2>"));
  EXPECT_THAT(message_of<MismatchError>([&] { reported(given, {2}, {}, {"gallery"}); }),
              HasSubstr("is a run by given regions, which have no components"));
}

TEST(Report, QuotesTheRunForAShell) {
  ReportStudy found = regions_study();
  found.run.arguments = {"regions", "my take's.npy", "", "--k=3"};
  EXPECT_TRUE(holds(report_page(found, {}, "").html,
                    "mimetra regions &#39;my take&#39;\\&#39;&#39;s.npy&#39; &#39;&#39; --k=3<"));
}

TEST(Report, GivesItsPicturesAsFilesToo) {
  for (const char* name : {"gallery", "weights-plot", "table-plot"}) {
    const Image picture =
        std::get<Pictures>(transfer_report().outputs.at(name).front().data).draw(0);
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

TEST(Report, TellsWhichInputsHaveChanged) {
  RunRead run = run_of("transfer", "actor", {{"k", std::int64_t{2}}});
  run.record.changed = {"takes/<3>.ply"};
  std::vector<std::string> warnings;
  const Log log = [&warnings](LogLevel level, const std::string& message) {
    if (level == LogLevel::warning) warnings.push_back(message);
  };
  const std::string page = page_of(reported(run, {2}, log));
  EXPECT_THAT(warnings, testing::Contains(HasSubstr("takes/<3>.ply: has changed since")));
  EXPECT_TRUE(holds(page,
                    "Changed since; this page shows what they give now:</p>\n<ul>\n"
                    "<li>takes/&lt;3&gt;.ply</li>"));
}

}  // namespace
}  // namespace mimetra
