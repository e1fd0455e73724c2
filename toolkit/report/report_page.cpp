#include "toolkit/report/report_page.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <future>

#include "toolkit/mesh/text.h"
#include "toolkit/report/viewer_data.h"

namespace mimetra {

namespace {

/// Style of a report: system fonts on white, as wide as the window up to a limit.
constexpr const char* kReportStyle = R"css(
:root { --ink: #1c1f24; --soft: #5b626d; --line: #dfe2e6; --accent: #0072b2; }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; max-width: 1180px; padding: 1.5rem 1.25rem 2.5rem; color: var(--ink);
  background: #fff; font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; }
h1 { margin: 0; font-size: 1.6rem; line-height: 1.25; font-weight: 650; overflow-wrap: anywhere; }
h2 { margin: 0 0 .35rem; font-size: 1.15rem; font-weight: 650; }
p { margin: 0 0 .9rem; max-width: 46rem; }
.soft, figcaption { color: var(--soft); }
section { margin-top: 2rem; }
dl.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(8.5rem, 1fr));
  gap: .6rem 1.25rem; margin: .9rem 0 0; padding: .7rem 0; border: solid var(--line);
  border-width: 1px 0; }
dl.facts dt { color: var(--soft); font-size: .82rem; }
dl.facts dd { margin: 0; font-size: 1.12rem; font-variant-numeric: tabular-nums;
  overflow-wrap: anywhere; }
.names { display: flex; align-items: end; font-size: .9rem; color: var(--soft); }
.names span { flex: 1 1 0; min-width: 0; padding: 0 .5rem; text-align: center;
  overflow-wrap: anywhere; }
#stage { position: relative; height: clamp(16rem, 54vh, 34rem); border: 1px solid var(--line);
  border-radius: .5rem; overflow: hidden; cursor: grab; }
#stage > div { position: absolute; inset: 0; outline: none; }
#stage canvas { display: block; width: 100%; height: 100%; }
.controls { display: flex; flex-wrap: wrap; align-items: center; gap: .6rem .9rem;
  margin: .7rem 0 .4rem; font-size: .95rem; }
.controls .timeline { display: flex; flex: 1 1 16rem; align-items: center; gap: .7rem; }
.controls input { flex: 1 1 auto; min-width: 0; height: 2rem; margin: 0; accent-color: var(--accent); }
.controls output { min-width: 4.2rem; text-align: right; font-variant-numeric: tabular-nums; }
button, select { min-height: 2.4rem; padding: .25rem .7rem; border: 1px solid #c3c8cf;
  border-radius: .4rem; background: #fff; color: inherit; font: inherit; }
button { cursor: pointer; }
#play { min-width: 5rem; border-color: var(--accent); background: var(--accent); color: #fff; }
button:hover, select:hover { border-color: var(--ink); }
:focus-visible { outline: 3px solid #56b4e9; outline-offset: 1px; }
#scale { display: flex; align-items: center; gap: .5rem; font-size: .9rem; color: var(--soft); }
#scale[hidden] { display: none; }
#scale i { width: 9rem; height: .75rem; border-radius: .2rem; }
#legend { display: flex; flex-wrap: wrap; gap: .3rem .8rem; font-size: .9rem; color: var(--soft); }
#legend[hidden], #legend span[hidden] { display: none; }
#legend i { display: inline-block; width: .9rem; height: .9rem; margin-right: .3rem; border-radius: .2rem;
  vertical-align: -.1rem; }
#picked { color: var(--ink); }
figure { margin: 0; }
img { display: block; width: 100%; height: auto; }
.strip img { max-width: 1180px; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr));
  gap: 1rem 1.5rem; }
table { width: 100%; border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .35rem .5rem; border-bottom: 1px solid var(--line); text-align: right;
  vertical-align: bottom; }
th { font-size: .82rem; font-weight: 500; line-height: 1.3; color: var(--soft); }
td { white-space: nowrap; }
th:first-child, td:first-child { padding-left: 0; text-align: left; }
th:last-child, td:last-child { padding-right: 0; }
tr.main td { font-weight: 650; }
.rows { margin-bottom: 1.25rem; }
pre { margin: 0 0 .9rem; padding: .7rem .9rem; border-radius: .4rem; background: #f4f5f7;
  font: .88rem/1.5 ui-monospace, Menlo, Consolas, monospace; white-space: pre-wrap;
  overflow-wrap: anywhere; }
ul { margin: 0 0 .9rem; padding-left: 1.2rem; }
li { overflow-wrap: anywhere; }
summary { cursor: pointer; color: var(--accent); }
details table { max-width: 36rem; margin-top: .5rem; }
@media (max-width: 700px) {
  body { padding: 1rem 1rem 2rem; }
  h1 { font-size: 1.3rem; }
  dl.facts { grid-template-columns: repeat(2, 1fr); }
  #stage { height: 19rem; }
  .controls .timeline { flex-basis: 100%; order: -2; }
  .controls button { flex: 1 1 40%; order: -1; }
  .controls label { flex: 1 1 40%; min-width: 0; }
  .controls label select { width: 100%; }
  th, td { padding: .35rem .2rem; font-size: .85rem; }
  th { font-size: .72rem; }
}
)css";

/// A picture as the page contains it.
struct PagePicture {
  std::string address;  ///< a data URL with the picture itself
  int width;
  int height;
};

/// A picture for windows, and one with fewer columns for phones.
struct PicturePair {
  PagePicture wide;
  PagePicture narrow;
};

/// Compresses the picture in another thread while the next is drawn, unless there is only one
/// thread.
std::future<PagePicture> page_picture(Image image, const Context& context) {
  const auto launch = context.threads() == 1 ? std::launch::deferred : std::launch::async;
  return std::async(launch, [image = std::move(image)] {
    return PagePicture{"data:image/png;base64," + base64(png_of(image)), image.width, image.height};
  });
}

std::string size_of(const PagePicture& picture) {
  return " width=\"" + std::to_string(picture.width) + "\" height=\"" +
         std::to_string(picture.height) + '"';
}

std::string figure(const PagePicture& picture, const std::string& says) {
  return "<figure><img src=\"" + picture.address + '"' + size_of(picture) + " alt=\"" +
         escaped_for_xml(says) + "\"></figure>\n";
}

std::string figure(const PicturePair& pictures, const std::string& says) {
  return "<figure class=\"strip\"><picture><source media=\"(max-width: 700px)\" srcset=\"" +
         pictures.narrow.address + '"' + size_of(pictures.narrow) + "><img src=\"" +
         pictures.wide.address + '"' + size_of(pictures.wide) + " alt=\"" + escaped_for_xml(says) +
         "\"></picture></figure>\n";
}

std::string section(const std::string& title, const std::string& text, const std::string& content) {
  return "<section>\n<h2>" + title + "</h2>\n<p class=\"soft\">" + text + "</p>\n" + content +
         "</section>\n";
}

std::string cell(const std::string& content) {
  return "<td>" + content + "</td>";
}

std::string number(const std::optional<double>& value, int digits = 3) {
  return value ? readable(*value, digits) : "";
}

/// `value` with its sign and two decimals. Negative values are worse than the full transfer.
std::string signed_percent(double value) {
  return (std::signbit(value) ? "" : "+") + fixed(value, 2);
}

/// Quotes an argument for a POSIX shell.
std::string shell_quoted(const std::string& argument) {
  const bool is_plain = std::ranges::all_of(argument, [](unsigned char letter) {
    return std::isalnum(letter) || letter >= 0x80 ||
           std::string_view("_@%+=:,./-").find(static_cast<char>(letter)) != std::string::npos;
  });
  if (is_plain && !argument.empty()) return argument;
  std::string quoted = "'";
  for (const char letter : argument) quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
  return quoted + '\'';
}

class PageText {
 public:
  PageText(const ReportStudy& study, const ReportView& view) : study_(study), view_(view) {}

  std::string title() const {
    return escaped_for_xml(study_.source) +
           (study_.transfer ? " → " + escaped_for_xml(study_.transfer->target) : "");
  }

  std::string facts() const {
    const Regions& regions = study_.regions;
    std::string list;
    const auto add = [&list](const std::string& name, const std::string& value) {
      list += "<div><dt>" + name + "</dt><dd>" + value + "</dd></div>\n";
    };
    add("frames", std::to_string(study_.sequence.frames()));
    add("vertices", std::to_string(study_.sequence.vertices()));
    add("regions", std::to_string(regions.regions.size()));
    add("triangles inside", percent(regions.triangle_share()));
    if (regions.energy_is_known()) {
      add("motion inside", percent(regions.energy_share));
    }
    if (study_.transfer) {
      const EvaluationRow& row = study_.transfer->rows[study_.transfer->main_row];
      if (row.mpe_all) add("MPE against full", signed_percent(*row.mpe_all) + " %");
      add("transfer", readable(row.transfer_seconds, 2) + " s");
    }
    return "<dl class=\"facts\">\n" + list + "</dl>\n";
  }

  /// Differences between the display and the files.
  std::string remarks() const {
    std::string text;
    if (study_.moved_head) text += "Shown without the head's motion. ";
    if (study_.transfer && study_.transfer->shown_scale != 1) {
      text += "The target is shown " + readable(study_.transfer->shown_scale, 3) +
              " times its size: its unit of length seems to be another.";
    }
    return text.empty() ? "" : "<p class=\"soft\">" + text + "</p>\n";
  }

  std::string player() const {
    const std::string& target = study_.transfer ? study_.transfer->target : study_.source;
    std::string names =
        "<span data-role=\"source\">source: " + escaped_for_xml(study_.source) + "</span>";
    std::string shown;
    if (study_.transfer) {
      names += "<span data-role=\"target\">target: " + escaped_for_xml(target) + "</span>";
      shown =
          "<label>show <select id=\"shown\"><option value=\"all\">both</option>"
          "<option value=\"source\">source</option><option value=\"target\">target</option>"
          "</select></label>\n";
    }
    return R"(<noscript><p>The 3D viewer needs JavaScript.</p></noscript>
<p id="no-webgl" hidden>This browser has no WebGL 2, which the 3D viewer needs.</p>
<div id="player" hidden>
<div class="names">)" +
           names + R"(</div>
<div id="stage"></div>
<div class="controls">
<button id="play" type="button">Play</button>
<div class="timeline"><input id="time" type="range" min="0" value="0" aria-label="time"><output id="clock" for="time"></output></div>
)" + shown +
           R"(<label>colour <select id="coloring"><option value="regions">regions</option><option value="displacement">displacement</option><option value="none">none</option></select></label>
<button id="reset" type="button">Reset view</button>
</div>
)" + scale() +
           "<div id=\"legend\"></div>\n"
           "<p class=\"soft\">Drag to turn, two fingers or Ctrl and the wheel to "
           "zoom, click to see what is there. <output id=\"picked\"></output></p>\n</div>\n";
  }

  std::string table() const {
    const ReportedTransfer& transfer = *study_.transfer;
    std::string rows;
    for (std::size_t i = 0; i < transfer.rows.size(); ++i) {
      const EvaluationRow& row = transfer.rows[i];
      const bool is_full = i + 1 == transfer.rows.size();
      rows += i == transfer.main_row ? "<tr class=\"main\">" : "<tr>";
      rows += cell(row.k     ? std::to_string(*row.k)
                   : is_full ? "full"
                             : "given") +
              cell(percent(row.triangle_share)) + cell(readable(row.de_all, 4)) +
              cell(row.mpe_all ? signed_percent(*row.mpe_all) : "") +
              cell(number(row.decompose_seconds, 2)) + cell(number(row.transfer_seconds, 2)) +
              "</tr>\n";
    }
    return "<table class=\"rows\">\n<thead><tr><th>K</th><th>triangles</th><th>DE" +
           (view_.unit.empty() ? "" : ", " + escaped_for_xml(view_.unit) + "²") +
           "</th><th>MPE, %</th><th>regions, s</th><th>transfer, s</th></tr></thead>\n<tbody>\n" +
           rows + "</tbody>\n</table>\n";
  }

  std::string region_table() const {
    std::string rows;
    for (std::size_t i = 0; i < study_.regions.regions.size(); ++i) {
      const Region& region = study_.regions.regions[i];
      rows += "<tr>" + cell(std::to_string(i)) +
              cell(region.component >= 0 ? std::to_string(region.component) : "") +
              cell(region.center >= 0 ? std::to_string(region.center) : "") +
              cell(readable(region.radius, 3)) + cell(std::to_string(region.vertices.size())) +
              cell(study_.regions.energy_is_known() ? percent(region.energy_share) : "") +
              "</tr>\n";
    }
    return "<details>\n<summary>All regions</summary>\n<table>\n<thead><tr><th>region</th>"
           "<th>component</th><th>centre vertex</th><th>radius</th><th>vertices</th><th>motion "
           "energy</th></tr>"
           "</thead>\n<tbody>\n" +
           rows + "</tbody>\n</table>\n</details>\n";
  }

  std::string run() const {
    std::string line = "mimetra";
    for (const std::string& argument : study_.run.arguments) line += ' ' + shell_quoted(argument);
    std::vector<std::string> changed;
    for (const auto& file : study_.run.changed) changed.push_back(file.string());
    return "<section>\n<h2>The run</h2>\n<pre>" + escaped_for_xml(line) + "</pre>\n" +
           list("What it warned of:", study_.notes) +
           list("Changed since; this page shows what they give now:", changed) + region_table() +
           "</section>\n";
  }

 private:
  /// Titled list of items; empty if there are none.
  static std::string list(const std::string& title, const std::vector<std::string>& items) {
    if (items.empty()) return "";
    std::string lines;
    for (const std::string& item : items) lines += "<li>" + escaped_for_xml(item) + "</li>\n";
    return "<p>" + title + "</p>\n<ul>\n" + lines + "</ul>\n";
  }

  std::string scale() const {
    std::string stops;
    for (int i = 0; i <= 8; ++i) {
      const Color color = even_color(i / 8.0);
      stops += ", rgb(" + std::to_string(color.red) + ' ' + std::to_string(color.green) + ' ' +
               std::to_string(color.blue) + ')';
    }
    return "<div id=\"scale\" hidden>0 <i style=\"background: linear-gradient(to right" + stops +
           ")\"></i> <span id=\"largest\"></span> " + escaped_for_xml(view_.unit) + "</div>\n";
  }

  const ReportStudy& study_;
  const ReportView& view_;
};

ViewerScene scene_of(const ReportStudy& study, const ReportView& view) {
  ViewerScene scene;
  scene.meshes.push_back(
      {"source", study.source, study.sequence, strongest_regions(study.regions)});
  if (study.transfer) {
    const ReportedTransfer& transfer = *study.transfer;
    scene.meshes.push_back(
        {"target", transfer.target, transfer.by_regions, transfer.regions_of_vertices});
  }
  scene.viewpoint = view.viewpoint;
  return scene;
}

std::string charts(const std::vector<Chart>& list, const Context& context) {
  // Large letters, because phones show the picture at less than half its size.
  constexpr ChartSize kSize{900, 700, 26};
  std::vector<std::future<PagePicture>> pictures;
  for (const Chart& chart : list) {
    pictures.push_back(page_picture(draw(std::vector<Chart>{chart}, kSize), context));
  }
  std::string figures;
  for (std::size_t i = 0; i < list.size(); ++i) figures += figure(pictures[i].get(), list[i].title);
  return "<div class=\"charts\">\n" + figures + "</div>\n";
}

/// Size of a sheet for one kind of window, which shows about as many pixels.
struct SheetSize {
  int columns;
  int tile_height;
  int letters;

  /// Size with `share` of the pixels, and a little less.
  SheetSize shrunk(double share) const {
    const double factor = 0.95 * std::sqrt(share);
    return {columns, std::max(kSmallestTile, static_cast<int>(tile_height * factor)),
            std::max(kSmallestLetters, static_cast<int>(letters * factor))};
  }

  static constexpr int kSmallestTile = 32;
  static constexpr int kSmallestLetters = 9;
};

/// Draws both pictures, and shrinks them if they would take more than `bytes`.
template <typename SheetOf>
PicturePair drawn(const SheetOf& sheet_of, SheetSize wide, SheetSize narrow, std::size_t bytes,
                  const Context& context) {
  const auto draw_one = [&](const SheetSize& size, const Context& part) {
    Sheet sheet = sheet_of(size.columns);
    sheet.tile_height = size.tile_height;
    sheet.letters = size.letters;
    return page_picture(draw(sheet, part), context);
  };
  for (double from = 0;; from += (1 - from) / 2) {
    const Context part = context.part(from, from + (1 - from) / 2);
    std::future<PagePicture> wide_picture = draw_one(wide, part.part(0, 0.6));
    std::future<PagePicture> narrow_picture = draw_one(narrow, part.part(0.6, 1));
    PicturePair pair{wide_picture.get(), narrow_picture.get()};
    const double share = static_cast<double>(bytes) /
                         static_cast<double>(pair.wide.address.size() + pair.narrow.address.size());
    if (share >= 1 || wide.tile_height == SheetSize::kSmallestTile) return pair;
    wide = wide.shrunk(share);
    narrow = narrow.shrunk(share);
  }
}

std::string strip_section(const ReportStudy& study, const ReportView& view, std::size_t bytes,
                          const Context& context) {
  const auto sheet = [&](int columns) { return report_strip(study, view, columns); };
  return section("Over time", "Frames at even distances, all at one scale.",
                 figure(drawn(sheet, {7, 230, 15}, {3, 220, 20}, bytes, context),
                        "Film strip of the source, its regions and what became of it"));
}

std::string gallery_section(const Components& components, const ReportView& view, std::size_t bytes,
                            const Context& context) {
  const std::vector<int> shown = strongest_components(components, kMostInGallery);
  const auto sheet = [&](int columns) {
    return component_gallery(components, shown, view, columns);
  };
  const bool has_all = static_cast<int>(shown.size()) == components.count();
  return section(
      "Components",
      (has_all ? "Each component"
               : "The " + std::to_string(shown.size()) + " strongest of " +
                     std::to_string(components.count()) + " components") +
          " at weight 1, the strongest first: its number, and its largest displacement, "
          "where it is darkest.",
      figure(drawn(sheet, {8, 210, 16}, {3, 220, 19}, bytes, context), "Gallery of components"));
}

/// Sections below the player. Strip and gallery leave part of `largest` bytes for the player.
std::string sections_below(const PageText& page, const ReportStudy& study, const ReportView& view,
                           std::size_t largest, const Context& context) {
  const std::size_t each = largest * 3 / 10;
  std::string sections = strip_section(study, view, each, context.part(0, 0.5));
  if (study.transfer) {
    sections +=
        section("Error and time",
                "The paper's Table I. DE: mean squared distance of the target's triangles from "
                "what the source's deformation makes of them (eq. 12). MPE: against the "
                "transfer by all triangles; negative is worse.",
                page.table() + charts(table_charts(*study.transfer, view.unit), context));
  }
  if (study.components) {
    sections += gallery_section(*study.components, view, each, context.part(0.5, 0.9));
  }
  const std::vector<Chart> weights = weight_charts(study);
  if (!weights.empty()) {
    sections += section("Weights", "The strongest ones over time.", charts(weights, context));
  }
  return sections + page.run();
}

}  // namespace

ReportPage report_page(const ReportStudy& study, const ReportView& view, std::string_view viewer,
                       std::size_t largest, const Context& context) {
  const PageText page(study, view);
  const std::string head =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>" +
      page.title() + "</title>\n<style>" + kReportStyle +
      "</style>\n</head>\n<body>\n<header>\n<h1>" + page.title() + "</h1>\n" + page.remarks() +
      page.facts() + "</header>\n";
  // Load VTK before another thread starts, because only one thread may load it.
  const DrawingSession session;
  const std::string player = "<section>\n" + page.player();
  const std::string before = "<script type=\"application/json\" id=\"performance\">";
  const std::string between = "</script>\n</section>\n";
  constexpr const char* kEnd = "</body>\n</html>\n";
  constexpr std::size_t kTags = 100;
  const std::size_t always =
      head.size() + player.size() + before.size() + between.size() + viewer.size() + kTags;
  const auto packed_beside = [&](std::size_t used, const Context& packing) {
    if (viewer.empty() || used >= largest) return PackedScene{};
    return packed(scene_of(study, view), largest - used, packing);
  };
  // Pack the scene meanwhile, as if pictures took no bytes. Only this thread reports progress.
  std::future<PackedScene> ahead =
      std::async(context.threads() == 1 ? std::launch::deferred : std::launch::async, packed_beside,
                 always, Context().with_threads(context.threads()));
  const std::string rest = sections_below(page, study, view, largest, context);
  PackedScene scene = ahead.get();
  const std::size_t used = always + rest.size();
  if (used + scene.json.size() > largest) scene = packed_beside(used, context.part(0.9, 0.9));

  if (scene.json.empty()) {
    const std::string why = viewer.empty() ? "this mimetra was built without npm"
                                           : "the mesh is too large for a page of this size";
    return {head + "<section>\n<p class=\"soft\">No 3D viewer: " + why + ".</p>\n</section>\n" +
                rest + kEnd,
            0};
  }
  return {head + player + before + scene.json + between + rest + "<script>" + std::string(viewer) +
              "</script>\n" + kEnd,
          scene.frames};
}

}  // namespace mimetra
