#include "toolkit/pictures/render_operation.h"

#include <sstream>

#include <nlohmann/json.hpp>

#include "toolkit/operations/json.h"
#include "toolkit/pictures/film_strip.h"

namespace mimetra {

namespace {

enum class Layout { strip, frame, turntable };

constexpr std::string_view choice_name(Layout value) {
  switch (value) {
    case Layout::strip:
      return "strip";
    case Layout::frame:
      return "frame";
    case Layout::turntable:
      return "turntable";
  }
  return {};
}

enum class UpAxis { y, z };

constexpr std::string_view choice_name(UpAxis value) {
  switch (value) {
    case UpAxis::y:
      return "y";
    case UpAxis::z:
      return "z";
  }
  return {};
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  if (text.ends_with(',')) parts.emplace_back();
  return parts;
}

StripOptions options_of(const Invocation& invocation) {
  const Parameters& parameters = invocation.parameters;
  const std::vector<NamedData>& inputs = invocation.inputs.at("input");
  StripOptions options;
  const auto layout = parameters.choice<Layout>("layout");
  if (layout == Layout::turntable) options.layout = StripLayout::turntable;
  options.columns = layout == Layout::frame ? 1 : parameters.integer("columns");
  if (parameters.is_set("at")) {
    for (const std::int64_t frame : parameters.integers("at")) {
      options.frames.push_back(static_cast<int>(frame));
    }
  }
  if (layout != Layout::strip && options.frames.size() > 1) {
    throw UsageError("--at: expected one frame with --layout " + parameters.text("layout"));
  }
  options.colors = split(parameters.text("color"));
  if (const auto titles = parameters.optional_text("titles")) {
    options.titles = split(*titles);
  } else if (inputs.size() > 1) {
    for (const NamedData& input : inputs) options.titles.push_back(input.name);
  }
  options.maximum = parameters.optional_number("maximum");
  options.yaw = parameters.number("yaw");
  options.pitch = parameters.number("pitch");
  options.z_up = is_z_up(parameters);
  options.tile_height = parameters.integer("size");
  options.unit = parameters.optional_text("unit").value_or("");
  return options;
}

Sheet sheet_of(const Invocation& invocation) {
  std::vector<FieldSequence> sequences;
  for (const NamedData& input : invocation.inputs.at("input")) {
    sequences.push_back(std::get<FieldSequence>(input.data));
  }
  return film_strip(sequences, options_of(invocation));
}

Outcome run_render(const Invocation& invocation) {
  const Sheet sheet = sheet_of(invocation);
  Image image = draw(sheet, {.progress = invocation.progress});
  Outcome outcome;
  Json bars = Json::array();
  for (const TileRow& row : sheet.rows) {
    bars.push_back(row.bar ? Json{{"minimum", row.bar->minimum}, {"maximum", row.bar->maximum}}
                           : Json(nullptr));
  }
  outcome.report = Json{
      {"width", image.width},
      {"height", image.height},
      {"rows", sheet.rows.size()},
      {"columns", sheet.rows.front().tiles.size()},
      {"ranges", bars}}.dump();
  outcome.summary = std::to_string(image.width) + " x " + std::to_string(image.height) +
                    " pixels, " + std::to_string(sheet.rows.size()) + " rows of " +
                    std::to_string(sheet.rows.front().tiles.size()) + "\n";
  outcome.outputs["out"].push_back({"", Pictures::of(std::move(image))});
  return outcome;
}

std::vector<Parameter> parameters() {
  std::vector<Parameter> list = {
      choice_parameter("layout", Layout::strip,
                       "strip: a column a frame; frame: one; turntable: one from all around"),
      {"columns", ParameterKind::integer, std::int64_t{8}, "pictures in a row", "", 1, 100},
      {"at",
       ParameterKind::integer_list,
       {},
       "frames to show, 0-based; default spread evenly",
       "",
       0},
      {"color", ParameterKind::text, "none",
       "none, displacement, difference (from the row above) or a field; one for all rows or a "
       "list"},
      {"titles", ParameterKind::text, {}, "a title for each row, separated by commas"},
      {"maximum",
       ParameterKind::number,
       {},
       "value of the darkest colour; default the largest",
       "",
       1e-300},
  };
  const std::vector<Parameter> view = view_parameters();
  list.insert(list.end(), view.begin(), view.end());
  list.insert(list.end(), {
                              {"size", ParameterKind::integer, std::int64_t{320},
                               "height of one picture", "pixels", 16, 4096},
                              {"unit",
                               ParameterKind::text,
                               {},
                               "name of the meshes' unit of length, for the scale bar"},
                          });
  return list;
}

}  // namespace

std::vector<Parameter> view_parameters() {
  return {{"yaw", ParameterKind::number, 15.0, "seen from the side", "degrees", -360, 360},
          {"pitch", ParameterKind::number, 5.0, "seen from above", "degrees", -90, 90},
          choice_parameter("up", UpAxis::y,
                           "axis that points up; the face looks along +z, or -y where z is up")};
}

bool is_z_up(const Parameters& parameters) {
  return parameters.choice<UpAxis>("up") == UpAxis::z;
}

Operation render_operation() {
  Operation operation;
  operation.name = "render";
  operation.summary = "Draw sequences as rows of pictures: film strip, one frame or turntable";
  operation.inputs = {{"input", DataKind::sequence,
                       "sequences, a row each; .pvd and .vtp with their fields", false, true}};
  operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::pictures, ".png"}};
  operation.outputs.front().extensions = {".png"};
  operation.parameters = parameters();
  operation.examples = {
      "render take.npy regions.pvd actor_smile/ --color none,region,none -o strip.png",
      "render actor/ --layout turntable --columns 6 --unit mm -o actor.png"};
  operation.run = run_render;
  operation.memory = [](const Invocation& invocation) {
    return drawing_bytes(sheet_of(invocation));
  };
  return operation;
}

}  // namespace mimetra
