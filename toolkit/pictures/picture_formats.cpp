#include "toolkit/pictures/picture_formats.h"

#include <sstream>

#include <nlohmann/json.hpp>

#include "toolkit/io/format.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/frame_shapes.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/text.h"
#include "toolkit/pictures/film_strip.h"
#include "toolkit/pictures/table_chart.h"

namespace mimetra {

namespace {

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  if (text.ends_with(',')) parts.emplace_back();
  return parts;
}

std::vector<RowColor> colors_of(const std::string& text) {
  std::vector<RowColor> colors;
  for (const std::string& name : split(text)) {
    const auto measured = choice_of<StripColor>(name);
    colors.push_back(measured ? RowColor(*measured) : RowColor(name));
  }
  return colors;
}

std::string text_of(const std::vector<RowColor>& colors) {
  std::vector<std::string> names;
  for (const RowColor& color : colors) {
    const auto* measured = std::get_if<StripColor>(&color);
    names.emplace_back(measured ? choice_name(*measured) : std::get<std::string>(color));
  }
  return joined(names, ",");
}

BoundParameters<StripOptions> strip_parameters() {
  BoundParameters<StripOptions> list;
  return list
      .add("layout", StripOptions::kLayout,
           "strip: a column a frame; frame: one; turntable: one from all around")
      .add("columns", StripOptions::kColumns, "pictures in a row")
      .add("at", StripOptions::kFrames, "frames to show, 0-based; default spread evenly")
      .add({"color", ParameterKind::text, text_of(StripOptions{}.colors),
            joined(choice_names<StripColor>()) +
                " (from the row above) or a field; one for all rows or a list"},
           [](const Parameters& parameters, StripOptions& options) {
             options.colors = colors_of(parameters.text("color"));
           })
      .add({"titles", ParameterKind::text, {}, "a title for each row, separated by commas"},
           [](const Parameters& parameters, StripOptions& options) {
             options.titles = split(parameters.optional_text("titles").value_or(""));
           })
      .add("maximum", StripOptions::kMaximum, "value of the darkest colour; default the largest")
      .add(&StripOptions::viewpoint, viewpoint_parameters())
      .add("size", StripOptions::kTileHeight, "height of one picture")
      .add("unit", StripOptions::kUnit, "name of the meshes' unit of length, for the scale bar")
      .add("edges", StripOptions::kEdges, "draw the edges of the faces, too");
}

StripOptions options_of(const Invocation& invocation) {
  StripOptions options = strip_parameters().read(invocation.parameters);
  if (options.layout != StripLayout::strip && options.frames.size() > 1) {
    throw UsageError("--at: expected one frame with --layout " +
                     std::string(choice_name(options.layout)));
  }
  const std::vector<NamedData>& inputs = invocation.inputs.at("input");
  if (inputs.size() > 1 && !invocation.parameters.is_set("titles")) {
    for (const NamedData& input : inputs) options.titles.push_back(input.name);
  }
  return options;
}

Sheet sheet_of(const Invocation& invocation) {
  std::vector<FieldSequence> sequences;
  for (const NamedData& input : invocation.inputs.at("input")) {
    sequences.push_back(std::get<FieldSequence>(input.data));
  }
  return film_strip(sequences, options_of(invocation));
}

/// Warns about rows in another unit. All rows have one scale, so such a row would be a dot or
/// shrink the others to dots.
void warn_of_sizes(const std::vector<NamedData>& inputs, const Invocation& invocation) {
  const auto size = [](const NamedData& input) {
    return spread(std::get<FieldSequence>(input.data).frames->rest());
  };
  const double usual = size(inputs.front());
  for (const NamedData& input : inputs) {
    if (!is_other_size(size(input), usual)) continue;
    const bool larger = size(input) > usual;
    const double ratio = larger ? size(input) / usual : usual / size(input);
    invocation.warn(input.name + " is " + readable(ratio) + " times as " +
                    (larger ? "large" : "small") + " as " + inputs.front().name +
                    ", and all rows have one scale; bring them into one unit (convert, option "
                    "'scale')");
  }
}

Outcome run_render(const Invocation& invocation) {
  warn_of_sizes(invocation.inputs.at("input"), invocation);
  const Sheet sheet = sheet_of(invocation);
  Image image = draw(sheet, invocation.context);
  Outcome outcome;
  Json bars = Json::array();
  for (const TileRow& row : sheet.rows) {
    bars.push_back(row.bar ? Json{{"minimum", row.bar->minimum}, {"maximum", row.bar->maximum}}
                           : Json(nullptr));
  }
  outcome.report = json_text(Json{{"width", image.width},
                                  {"height", image.height},
                                  {"rows", sheet.rows.size()},
                                  {"columns", sheet.rows.front().tiles.size()},
                                  {"ranges", bars}});
  outcome.summary = std::to_string(image.width) + " x " + std::to_string(image.height) +
                    " pixels, " + std::to_string(sheet.rows.size()) +
                    (sheet.rows.size() == 1 ? " row of " : " rows of ") +
                    std::to_string(sheet.rows.front().tiles.size()) + "\n";
  outcome.outputs["out"].push_back({"", Pictures::of(std::move(image))});
  return outcome;
}

Operation render_operation() {
  Operation operation;
  operation.name = "render";
  operation.summary = "Draw sequences as rows of pictures: film strip, one frame or turntable";
  operation.inputs = {{"input", DataKind::sequence,
                       "sequences, a row each, with the fields that they have", false, true}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::pictures, "the picture"}};
  operation.outputs.front().extensions = {".png"};
  operation.parameters = strip_parameters().declared();
  operation.examples = {
      "render take.npy regions.pvd actor_smile/ --color none,region,none -o strip.png",
      "render actor/ --layout turntable --columns 6 --unit mm -o actor.png",
      "render take.npy take_coarse.npy --layout frame --edges --size 800 -o topology.png"};
  operation.run = run_render;
  operation.memory = [](const Invocation& invocation) {
    return drawing_bytes(sheet_of(invocation));
  };
  return operation;
}

Format::Paths write_picture(const Data& data, const std::filesystem::path& target,
                            const WriteOptions& options, const Context&) {
  return write_text(target, options, png_of(std::get<Pictures>(data).draw(0)));
}

Format::Paths write_table(const Data& data, const std::filesystem::path& target,
                          const WriteOptions& options, const Context&) {
  return write_text(target, options, png_of(draw({chart_of(std::get<Table>(data))})));
}

Format::Paths write_pictures(const Data& data, const std::filesystem::path& target,
                             const WriteOptions& options, const Context& context) {
  const auto& pictures = std::get<Pictures>(data);
  PendingOutputs outputs(options.overwrite, options.inputs, options.together);
  const std::filesystem::path folder = outputs.add(target, PendingOutput::Kind::folder);
  const auto name = [&](int i) { return frame_name(i, pictures.count, ".png"); };
  const auto write_one = [&](int i) { write_bytes(folder / name(i), png_of(pictures.draw(i))); };
  parallel_for(pictures.count, write_one, context);
  for (const auto& [extra, content] : options.extra) write_bytes(folder / extra, content);
  outputs.commit();
  std::vector<std::filesystem::path> files;
  files.reserve(static_cast<std::size_t>(pictures.count));
  for (int i = 0; i < pictures.count; ++i) files.push_back(target / name(i));
  return files;
}

}  // namespace

BoundParameters<Viewpoint> viewpoint_parameters() {
  BoundParameters<Viewpoint> list;
  return list.add("yaw", Viewpoint::kYaw, "seen from the side")
      .add("pitch", Viewpoint::kPitch, "seen from above")
      .add("up", Viewpoint::kUp,
           "axis that points up; the face looks along +z, or -y where z is up");
}

void add_pictures(OperationTable& table) {
  table.add(Format{.name = "picture",
                   .kind = DataKind::pictures,
                   .extensions = {".png"},
                   .write = write_picture});
  table.add(Format{.name = "folder of pictures",
                   .kind = DataKind::pictures,
                   .extensions = {Format::kFolder},
                   .write = write_pictures});
  table.add(Format{.name = "picture of a table",
                   .kind = DataKind::table,
                   .extensions = {".png"},
                   .write = write_table});
  table.add(render_operation());
}

}  // namespace mimetra
