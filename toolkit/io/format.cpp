#include "toolkit/io/format.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include "toolkit/io/material_library.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/tri_mesh.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {

namespace {

using Paths = Format::Paths;

std::string word_of(const std::string& extension) {
  if (extension == Format::kFolder) return "a folder";
  return extension == Format::kAnyFile ? "any file" : extension;
}

}  // namespace

bool Format::has(const std::string& extension) const {
  return std::ranges::find(extensions, extension) != extensions.end();
}

std::vector<Parameter> Format::options() const {
  std::vector<Parameter> all = reading;
  for (const Parameter& option : writing) {
    if (std::ranges::find(all, option.name, &Parameter::name) == all.end()) all.push_back(option);
  }
  return all;
}

void require_built(const Format& format, const std::string& text) {
  if (format.built_by.empty()) return;
  throw UsageError(text + ": " + format.name + " is not built into this program; build it with -D" +
                   format.built_by + "=ON");
}

std::string listed_extensions(std::vector<std::string> extensions) {
  std::stable_partition(extensions.begin(), extensions.end(),
                        [](const auto& each) { return each.starts_with('.'); });
  std::vector<std::string> words;
  for (const std::string& extension : extensions) {
    const std::string word = word_of(extension);
    if (std::ranges::find(words, word) == words.end()) words.push_back(word);
  }
  return joined(words, ", ", " or ");
}

std::vector<std::string> notes_on_losses(const Format& format, const Data& data,
                                         const std::filesystem::path& target,
                                         const WriteOptions& options) {
  if (format.losses) return format.losses(data, target);
  const auto* sequence = std::get_if<FieldSequence>(&data);
  if (!sequence || format.weights) return {};
  std::vector<std::string> notes;
  if (!sequence->fields.empty() && !format.fields) {
    std::vector<std::string> names;
    for (const Field& field : sequence->fields) names.push_back(field.name);
    notes.push_back(target.string() + ": this format holds no fields; without " + joined(names));
  }
  if (format.displacements && std::ranges::any_of(sequence->fields, is_displacement) &&
      has_left_its_rest(*sequence->frames)) {
    notes.push_back(target.string() + ": the input's field '" + kDisplacement +
                    "' is replaced by the displacement from the rest pose; give it another name to "
                    "keep it");
  }
  if (!format.holds) return notes;
  const HeldParts held = format.holds(options);
  const auto lost = parts_left_out(held, *sequence->frames);
  if (!lost.empty()) {
    notes.push_back(target.string() + ": this format holds no " + joined(lost, ", ", " or ") +
                    "; written without");
  }
  if (held.groups) {
    const Connectivity& connectivity = sequence->frames->connectivity();
    const bool is_folder = format.has(Format::kFolder);
    const WrittenMaterials materials = is_folder ? materials_in_folder(connectivity, target)
                                                 : materials_beside(connectivity, target);
    notes.insert(notes.end(), materials.notes.begin(), materials.notes.end());
  }
  return notes;
}

Paths write_with_extra(const std::filesystem::path& target, const WriteOptions& options,
                       const std::function<Paths()>& write) {
  // Makes parent folders of the target first; they are removed again if writing fails.
  PendingOutputs extra(options.overwrite, options.inputs, options.together);
  Paths beside;
  for (const auto& [name, content] : options.extra) {
    beside.push_back(target.parent_path() / name);
    write_bytes(extra.add(beside.back(), PendingOutput::Kind::file, existing_beside(name)),
                content);
  }
  Paths written = write();
  extra.commit();
  written.insert(written.end(), beside.begin(), beside.end());
  return written;
}

Paths write_text(const std::filesystem::path& target, const WriteOptions& options,
                 const std::string& text) {
  return write_with_extra(target, options, [&]() -> Paths {
    PendingOutputs outputs(options.overwrite, options.inputs, options.together);
    write_bytes(outputs.add(target, PendingOutput::Kind::file), text);
    outputs.commit();
    return {target};
  });
}

const FieldSequence& shown_regions(const Data& regions, const std::filesystem::path& target) {
  const FieldSequence& shown = std::get<RegionData>(regions).fields;
  if (shown.frames->frames() > 0) return shown;
  throw MismatchError(target.string() +
                      ": the regions come without a mesh to show them on; write .json or .csv");
}

Paths write_document(const Data& document, const std::filesystem::path& target,
                     const WriteOptions& options, const Context&) {
  return write_text(target, options, std::get<Document>(document).text);
}

namespace {

bool has_polygons(const Connectivity& connectivity) {
  return connectivity.triangles.rows() > connectivity.polygons.size();
}

bool has_statement(const Connectivity& connectivity, std::string_view keyword) {
  return std::ranges::any_of(connectivity.groups, [keyword](const FaceGroup& group) {
    return group.statement.starts_with(keyword) && group.statement.size() > keyword.size() &&
           group.statement[keyword.size()] == ' ';
  });
}

/// True if numbering positions by their first use in the triangles keeps every vertex's number.
bool is_numbered_by_use(const FrameSource& sequence) {
  int vertices = 0;
  for (const VertexIndex vertex : sequence.triangles().reshaped<Eigen::RowMajor>()) {
    if (vertex > vertices) return false;
    if (vertex == vertices) ++vertices;
  }
  return vertices == sequence.vertices() && Weld::exact(sequence.rest()).count == 0;
}

bool is_its_only_frame(const FrameSource& sequence) {
  return sequence.frames() == 1 &&
         FrameBlock(sequence, 0, 1).frame(0) ==
             PositionsView(sequence.rest().data(), sequence.vertices(), 3);
}

void add_lost_texture(std::vector<std::string>& lost, const HeldParts& held,
                      const Connectivity& connectivity) {
  if (!has_texture(connectivity)) return;
  const auto is_bare = [](int coordinates) { return coordinates < 0; };
  if (held.texture == HeldParts::Texture::none) {
    lost.emplace_back("texture coordinates");
  } else if (held.texture == HeldParts::Texture::vertices && !texture_of_vertices(connectivity)) {
    lost.emplace_back("texture coordinates of a mesh with several at a vertex");
  } else if (!held.bare_faces && std::ranges::any_of(connectivity.texture.corners, is_bare)) {
    lost.emplace_back("faces without texture coordinates");
  }
}

/// Largest change of a time by rounding to single precision, in seconds. Returns 0 if that is at
/// most a thousandth of the shortest step.
double rounding_of(const Eigen::VectorXd& times) {
  constexpr double kLeastShare = 1e-3;
  if (times.size() < 2) return 0;
  const Eigen::Index steps = times.size() - 1;
  const double step = (times.tail(steps) - times.head(steps)).minCoeff();
  const double rounded = (times.cast<float>().cast<double>() - times).cwiseAbs().maxCoeff();
  return rounded > kLeastShare * step ? rounded : 0;
}

/// Largest distance of a time from even spacing, in seconds. Returns 0 if that is at most a
/// hundredth of the mean step.
double unevenness_of(const Eigen::VectorXd& times) {
  constexpr double kLeastShare = 0.01;
  if (times.size() < 3) return 0;
  const double first = times[0], last = times[times.size() - 1];
  const Eigen::VectorXd even = Eigen::VectorXd::LinSpaced(times.size(), first, last);
  const double farthest = (times - even).cwiseAbs().maxCoeff();
  const double step = (last - first) / static_cast<double>(times.size() - 1);
  return farthest > kLeastShare * step ? farthest : 0;
}

}  // namespace

std::string description(const HeldParts& held) {
  std::vector<std::string> words = {held.polygons ? "polygons" : "triangles"};
  if (held.texture == HeldParts::Texture::vertices) words.emplace_back("UVs of vertices");
  if (held.texture == HeldParts::Texture::corners) words.emplace_back("UVs");
  if (held.groups) words.emplace_back("groups and materials");
  if (held.rest) words.emplace_back("rest pose");
  if (!held.vertex_order) words.emplace_back("no order of vertices");
  return joined(words);
}

std::vector<std::string> parts_left_out(const HeldParts& held, const FrameSource& sequence) {
  const Connectivity& connectivity = sequence.connectivity();
  std::vector<std::string> lost;
  if (!held.polygons && has_polygons(connectivity)) {
    lost.emplace_back("faces of more than three corners");
  }
  add_lost_texture(lost, held, connectivity);
  if (!held.groups) {
    if (has_statement(connectivity, "g") || has_statement(connectivity, "o")) {
      lost.emplace_back("groups");
    }
    if (has_statement(connectivity, "usemtl")) lost.emplace_back("materials");
  }
  if (!held.rest && sequence.rest_is_known() && !is_its_only_frame(sequence)) {
    lost.emplace_back("rest pose");
  }
  if (!held.vertex_order && !is_numbered_by_use(sequence)) lost.emplace_back("order of vertices");
  if (const Eigen::VectorXd times = sequence.known_times();
      !held.times && times.size() > 0 && times[0] != 0) {
    lost.push_back("time (its frame is at " + readable(times[0]) + " s)");
  }
  if (const double off = held.uneven_times ? 0 : unevenness_of(sequence.known_times()); off > 0) {
    lost.push_back("uneven times (programs that do not read the .times.csv beside it show frames " +
                   readable(off, 2) + " s off)");
  }
  if (const double rounded = held.exact_times ? 0 : rounding_of(sequence.known_times());
      rounded > 0) {
    lost.push_back("exact times (rounded by up to " + readable(rounded) + " s)");
  }
  const Positions& rest = sequence.rest();
  const double size = extent(rest);
  if (!held.exact_positions && needs_double({rest.data(), rest.rows(), 3}, size)) {
    const double farthest = rest.cwiseAbs().maxCoeff();
    lost.push_back("exact positions (rounded by up to " +
                   readable(std::numeric_limits<float>::epsilon() / 2 * farthest, 2) +
                   ", as the mesh lies " + readable(farthest / size, 2) +
                   " times its size from the origin)");
  }
  return lost;
}

}  // namespace mimetra
