#include "toolkit/formats/model_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "toolkit/formats/eos.h"
#include "toolkit/formats/gltf/scene.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

double coefficient_of(const std::string& entry, const std::string& number) {
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (number.empty() || error != std::errc() || end != number.data() + number.size() ||
      !std::isfinite(value)) {
    throw std::invalid_argument("'" + entry + "': expected NAME=NUMBER as in identity003=1.5");
  }
  return value;
}

/// `at` is the offset of the last '@'; the file's folders may contain others.
ModelSpec with_fit(const std::string& text, std::size_t at) {
  for (auto here = text.find('@'); here < at; here = text.find('@', here + 1)) {
    if (is_there(text.substr(0, here))) at = here;
  }
  const std::string file = text.substr(at + 1);
  return {text.substr(0, at), {}, file, file};
}

ModelSpec parsed_spec(const std::string& text) {
  ModelSpec spec;
  const auto slash = text.find_last_of('/');
  const auto at = text.find_last_of('@');
  if (at != std::string::npos && text.ends_with(".json") && !is_there(text)) {
    return with_fit(text, at);
  }
  if (at == std::string::npos || (slash != std::string::npos && at < slash) || is_there(text)) {
    spec.path = text;
    return spec;
  }
  spec.path = text.substr(0, at);
  spec.identity_text = text.substr(at + 1);
  std::string rest = spec.identity_text + ',';
  for (auto comma = rest.find(','); comma != std::string::npos; comma = rest.find(',')) {
    const std::string entry = rest.substr(0, comma);
    rest.erase(0, comma + 1);
    const auto equals = entry.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw std::invalid_argument("'" + entry + "': expected NAME=NUMBER as in identity003=1.5");
    }
    const std::string name = entry.substr(0, equals);
    const auto is_given = [&](const auto& given) { return given.first == name; };
    if (std::ranges::any_of(spec.identity, is_given)) {
      throw std::invalid_argument("'" + text + "': '" + name + "' is given twice");
    }
    spec.identity.emplace_back(name, coefficient_of(entry, entry.substr(equals + 1)));
  }
  return spec;
}

}  // namespace

ModelSpec ModelSpec::parse(const std::string& text) {
  ModelSpec spec = parsed_spec(text);
  if (!spec.path.empty()) return spec;
  throw std::invalid_argument("'" + text + "': names no model");
}

std::vector<std::string> ModelSpec::notes() const {
  // In standard deviations, or as factors of an identity.
  constexpr double kMostDeviations = 10;
  std::vector<std::string> notes;
  for (const auto& [identity_name, coefficient] : identity) {
    if (std::abs(coefficient) <= kMostDeviations) continue;
    notes.push_back(path.string() + ": " + identity_name + " is " + readable(coefficient) +
                    ", expected about -3 to 3");
  }
  if (fit && !read_fit(*fit).has_one_identity()) {
    notes.push_back(fit->string() +
                    ": holds an identity for each frame, and the person is their mean; `mimetra "
                    "fit` without `--shape frame` fits one for the clip");
  }
  return notes;
}

std::string ModelSpec::name() const {
  // For "." and "ict-face/", use the folder's name.
  const fs::path last = without_trailing_slash(fs::absolute(path));
  std::error_code unreadable;
  const std::string stem =
      fs::is_directory(path, unreadable) ? last.filename().string() : last.stem().string();
  if (!fit) return identity_text.empty() ? stem : stem + '@' + identity_text;
  fs::path fitted = fit->stem();
  if (fitted.extension() == ".fit") fitted = fitted.stem();
  return stem + '@' + fitted.string();
}

namespace {

/// Regular files and dangling links of a folder, in natural order; reading a dangling link fails
/// later. Empty if `folder` is not a folder.
std::vector<fs::path> sorted_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const bool hidden = entry->path().filename().string().starts_with('.');
    std::error_code missing;
    const bool is_dangling = entry->is_symlink(missing) && !entry->exists(missing);
    // Reading refuses devices and pipes.
    if (!hidden && (is_dangling || !entry->is_directory(missing))) files.push_back(entry->path());
  }
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

/// First file of a folder whose name starts with `start` and ends with `end`.
std::optional<fs::path> file_like(const fs::path& folder, const std::string& start,
                                  const std::string& end) {
  for (const fs::path& file : sorted_files_in(folder)) {
    const std::string name = file.filename().string();
    if (name.starts_with(start) && name.ends_with(end)) return file;
  }
  return {};
}

/// Shape model of an eos pair, found by its usual name or else by its first bytes.
std::optional<fs::path> eos_shape_of(const fs::path& folder) {
  if (const auto usual = file_like(folder, "sfm_shape", ".bin")) return usual;
  for (const fs::path& file : sorted_files_in(folder)) {
    if (file.extension() == ".bin" && is_eos_shape(file)) return file;
  }
  return {};
}

std::optional<fs::path> eos_expressions_of(const fs::path& folder) {
  return file_like(folder, "expression_blendshapes", ".bin");
}

std::vector<fs::path> meshes_in(const fs::path& folder) {
  std::vector<fs::path> files = sorted_files_in(folder);
  std::erase_if(files,
                [](const fs::path& file) { return !is_mesh_extension(file.extension().string()); });
  return files;
}

std::optional<fs::path> neutral_of(const fs::path& folder) {
  const std::vector<fs::path> meshes = meshes_in(folder);
  const auto found = std::ranges::find_if(meshes, is_neutral);
  return found == meshes.end() ? std::nullopt : std::optional(*found);
}

/// Subfolders, sorted by name.
std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code missing;
    if (entry->is_directory(missing)) folders.push_back(entry->path());
  }
  std::ranges::sort(folders);
  return folders;
}

/// First subfolder with one of the names; ignores case if none matches exactly.
std::optional<fs::path> folder_called(const fs::path& parent,
                                      const std::vector<std::string>& names) {
  const std::vector<fs::path> folders = folders_in(parent);
  using Spelling = std::string (*)(const std::string&);
  const Spelling as_is = [](const std::string& name) { return name; };
  const Spelling in_any_case = [](const std::string& name) { return lower_case(name); };
  for (const Spelling spelling : {as_is, in_any_case}) {
    for (const std::string& name : names) {
      const auto found = std::ranges::find_if(folders, [&](const fs::path& folder) {
        return spelling(folder.filename().string()) == name;
      });
      if (found != folders.end()) return *found;
    }
  }
  return {};
}

std::optional<fs::path> expressions_in(const fs::path& folder) {
  return folder_called(folder, {"expressions", "targets"});
}

std::optional<fs::path> identities_in(const fs::path& folder) {
  return folder_called(folder, {"identities"});
}

[[noreturn]] void fail_second_shape(const fs::path& file, const fs::path& other) {
  throw IoError(file.string(), "is a second shape named '" + file.stem().string() + "', beside " +
                                   other.filename().string() + "; rename or remove one of them");
}

/// Throws IoError if two files have the same stem, since that is the shape's name.
void check_names(const std::vector<fs::path>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (files[i].stem() == files[j].stem()) fail_second_shape(files[i], files[j]);
    }
  }
}

/// Paths of a model's parts.
struct Parts {
  std::optional<fs::path> neutral;
  std::optional<fs::path> shape;        // eos
  std::optional<fs::path> expressions;  // a folder, or the eos blendshapes
  std::optional<fs::path> identities;
};

Parts parts_from_json(const fs::path& file) {
  Parts parts;
  try {
    const Json json = read_json(file, "a JSON object of paths");
    if (!json.is_object()) throw IoError(file.string(), "expected a JSON object of paths");
    const auto entry = [&](const char* name) -> std::optional<fs::path> {
      if (!json.contains(name)) return {};
      return file.parent_path() / json.at(name).get<std::string>();
    };
    parts = {entry("neutral"), entry("shape"), entry("expressions"), entry("identities")};
  } catch (const Json::exception& error) {
    throw IoError(file.string(), "expected a JSON object of paths: " + json_reason(error));
  }
  if (!parts.neutral && !parts.shape) {
    throw IoError(file.string(), "names neither 'neutral' nor 'shape'");
  }
  return parts;
}

Parts parts_of(const fs::path& folder) {
  std::error_code unreadable;
  if (folder.extension() == ".bin" && fs::is_regular_file(folder, unreadable)) {
    const fs::path parent = folder.parent_path();
    return {{}, folder, eos_expressions_of(parent.empty() ? "." : parent), {}};
  }
  if (is_there(folder / "model.json")) return parts_from_json(folder / "model.json");
  Parts parts;
  parts.neutral = neutral_of(folder);
  if (parts.neutral) {
    std::vector<fs::path> neutrals = meshes_in(folder);
    std::erase_if(neutrals, std::not_fn(is_neutral));
    if (neutrals.size() > 1) fail_second_shape(neutrals[1], neutrals[0]);
    parts.expressions = expressions_in(folder);
    parts.identities = identities_in(folder);
  } else {
    parts.shape = eos_shape_of(folder);
    parts.expressions = eos_expressions_of(folder);
  }
  return parts;
}

/// Reads the absolute shapes in a folder and subtracts the neutral.
ShapeBasis read_shapes(const fs::path& folder, const MeshFileReader& neutral,
                       const Context& context) {
  ShapeBasis basis;
  std::vector<fs::path> files;
  for (const fs::path& file : meshes_in(folder)) {
    files.push_back(file);
    basis.names.push_back(file.stem().string());
  }
  check_links(files);
  check_names(files);
  if (files.empty()) throw IoError(folder.string(), "holds no .obj, .ply, .off or .stl file");
  const Positions& mean = neutral.mesh().positions;
  basis.displacements.resize(mean.size(), static_cast<Eigen::Index>(files.size()));
  const auto read = [&](int j) {
    auto shape = basis.displacements.col(j);
    neutral.read(files[static_cast<std::size_t>(j)],
                 {shape.data(), static_cast<std::size_t>(shape.size())});
    shape -= Eigen::Map<const Eigen::VectorXd>(mean.data(), mean.size());
  };
  parallel_for(static_cast<int>(files.size()), read, context);
  return basis;
}

ShapeBasis shapes_or_none(const std::optional<fs::path>& folder, const MeshFileReader& neutral,
                          const Context& context) {
  if (folder) return read_shapes(*folder, neutral, context);
  return {{}, Eigen::MatrixXd(neutral.mesh().positions.size(), 0)};
}

/// Description of identities for messages, such as "63 identities, from '0' to '62'".
std::string counted(const std::vector<std::string>& names) {
  if (names.empty()) return "no identities";
  return std::to_string(names.size()) + " identities, from '" + names.front() + "' to '" +
         names.back() + "'";
}

/// Fitted coefficients, in the model's order of identities.
Eigen::VectorXd fitted_identity(const ShapeBasis& identities, const ModelSpec& spec) {
  const FittedCoefficients fit = read_fit(*spec.fit);
  const Eigen::VectorXd alpha = fit.identity();
  Eigen::VectorXd result(identities.size());
  bool is_same_model = alpha.size() == result.size();
  for (Eigen::Index i = 0; is_same_model && i < alpha.size(); ++i) {
    const int index = identities.find(fit.identities[static_cast<std::size_t>(i)]);
    is_same_model = index >= 0;
    if (is_same_model) result[index] = alpha[i];
  }
  if (is_same_model) return result;
  throw MismatchError(spec.fit->string() + ": has " + counted(fit.identities) + ", but " +
                      spec.path.string() + " has " + counted(identities.names) +
                      "; it was fitted with another model");
}

/// Throws OutputError for a name that would leave its folder, or that reading would skip as a
/// hidden file.
void check_shape_name(const std::string& name) {
  if (!name.empty() && name.front() != '.' && name.find('/') == std::string::npos) return;
  throw OutputError(name + ".ply",
                    "a shape of this name cannot be stored as a file; a name must not "
                    "be empty, start with '.' or hold '/'");
}

void write_shapes(const fs::path& folder, const ShapeBasis& basis, const MorphableModel& model,
                  const Context& context) {
  if (basis.size() == 0) return;
  std::ranges::for_each(basis.names, check_shape_name);
  std::error_code error;
  if (!fs::create_directory(folder, error)) {
    throw OutputError(folder.string(), "cannot be written: " + error.message());
  }
  const MeshFileWriter writer(model.connectivity(), ".ply", true);
  for (int j = 0; j < basis.size(); ++j) {
    context.report(static_cast<double>(j) / basis.size());
    const Eigen::VectorXd field = basis.displacements.col(j);
    const Positions shape =
        model.mean() + Eigen::Map<const Positions>(field.data(), model.vertices(), 3);
    writer.write(folder / (basis.names[static_cast<std::size_t>(j)] + ".ply"),
                 PositionsView(shape.data(), shape.rows(), 3));
  }
}

/// Notes on meshes in subfolders of the expressions, and in the model's folders with a name that is
/// usual for expressions.
std::vector<std::string> notes_beside(const fs::path& model, const fs::path& expressions) {
  const std::vector<std::string> known = {"expressions",  "targets",      "blendshapes",
                                          "blend_shapes", "shapes",       "morphs",
                                          "morphtargets", "morph_targets"};
  std::vector<std::string> found;
  for (const fs::path& folder : folders_in(expressions)) {
    if (meshes_in(folder).empty()) continue;
    found.push_back((expressions.filename() / folder.filename()).string() + "/");
  }
  for (const fs::path& folder : folders_in(model)) {
    const std::string name = folder.filename().string();
    const bool is_other = folder != expressions && !meshes_in(folder).empty();
    if (is_other && std::ranges::find(known, lower_case(name)) != known.end()) {
      found.push_back(name + "/");
    }
  }
  if (found.empty()) return {};
  return {model.string() + ": meshes of " + joined(found, ", ", " and ") +
          " are not read; expressions are the files in " + expressions.filename().string() + "/"};
}

}  // namespace

std::vector<fs::path> meshes_beside_model(const fs::path& path) {
  const bool is_named_by_parts = !is_there(path / "model.json") && neutral_of(path);
  if (!is_named_by_parts) return {};
  std::vector<fs::path> files = meshes_in(path);
  std::erase_if(files, [](const fs::path& file) { return is_neutral(file) || is_companion(file); });
  return files;
}

std::vector<std::string> notes_on_unread(const fs::path& path) {
  std::error_code unreadable;
  if (!fs::is_directory(path, unreadable) || is_there(path / "model.json") || !neutral_of(path)) {
    return {};
  }
  if (const auto expressions = expressions_in(path)) return notes_beside(path, *expressions);
  std::vector<std::string> found;
  if (const auto beside = meshes_beside_model(path).size(); beside > 0) {
    found.push_back(std::to_string(beside) + " other mesh files");
  }
  for (const fs::path& folder : folders_in(path)) {
    if (folder != identities_in(path) && !meshes_in(folder).empty()) {
      found.push_back(folder.filename().string() + "/");
    }
  }
  if (found.empty()) return {};
  return {path.string() + ": has no expressions; " + joined(found, ", ", " and ") +
          " in it are not read, whose place would be expressions/ or targets/"};
}

std::vector<fs::path> model_files(const fs::path& path) {
  if (is_scene_file(path) || !is_model(path)) return {path};
  const Parts parts = parts_of(path);
  std::vector<fs::path> files;
  std::error_code unreadable;
  const fs::path list = path / "model.json";
  if (is_there(list)) files.push_back(list);
  for (const auto& part : {parts.neutral, parts.shape, parts.expressions, parts.identities}) {
    if (!part) continue;
    if (fs::is_directory(*part, unreadable)) {
      const std::vector<fs::path> shapes = meshes_in(*part);
      files.insert(files.end(), shapes.begin(), shapes.end());
    } else {
      files.push_back(*part);
    }
  }
  for (const fs::path& file : sorted_files_in(path)) {
    const std::string name = file.filename().string();
    const bool is_mapping =
        name == "landmarks68.txt" || (name.starts_with("ibug_to_") && name.ends_with(".txt"));
    if (is_mapping || name == "rules.json") files.push_back(file);
  }
  return files;
}

MorphableModel read_model(const fs::path& path, const Context& context) {
  if (!is_there(path)) throw IoError(path.string(), "does not exist");
  if (is_scene_file(path)) return MorphableModel(*read_gltf(path, context).model);
  const Parts parts = parts_of(path);
  if (parts.shape) {
    if (!parts.expressions) {
      throw IoError(path.string(), "holds an eos shape model but no expression_blendshapes_*.bin");
    }
    return read_eos(*parts.shape, *parts.expressions);
  }
  if (!parts.neutral) {
    throw IoError(
        path.string(),
        "is no model: expected neutral.* with expressions/ or targets/, a model.json, or "
        "the eos pair sfm_shape_*.bin and expression_blendshapes_*.bin" +
            std::string(meshes_in(path).size() > 1
                            ? "; its meshes can be frames of a sequence, which is a source"
                            : ""));
  }
  const MeshFileReader neutral(*parts.neutral, context.part(0, 0));
  const double half = parts.identities ? 0.5 : 1;
  ShapeBasis expressions = shapes_or_none(parts.expressions, neutral, context.part(0, half));
  ShapeBasis identities = shapes_or_none(parts.identities, neutral, context.part(half, 1));
  auto connectivity = std::make_shared<Connectivity>(neutral.mesh().connectivity);
  try {
    return MorphableModel(std::move(connectivity), neutral.mesh().positions, std::move(identities),
                          std::move(expressions));
  } catch (const std::invalid_argument& error) {
    // Two shapes have one name, such as smile.obj and smile.ply.
    throw IoError(path.string(), error.what());
  }
}

BlendshapeModel read_person(const ModelSpec& spec, const Context& context) {
  const MorphableModel model = read_model(spec.path, context);
  if (spec.fit) return model.person(fitted_identity(model.identities(), spec));
  Eigen::VectorXd alpha = Eigen::VectorXd::Zero(model.identities().size());
  for (const auto& [name, coefficient] : spec.identity) {
    const int index = model.identities().find(name);
    if (index < 0) {
      const auto& known = model.identities().names;
      throw MismatchError(spec.path.string() + ": no identity '" + name + "'; " +
                          (known.empty()
                               ? "the model has none"
                               : "there are " + std::to_string(known.size()) + ", from '" +
                                     known.front() + "' to '" + known.back() + "'"));
    }
    alpha[index] = coefficient;
  }
  return model.person(alpha);
}

BlendshapeModel read_blendshapes(const std::string& text, const Context& context) {
  return read_person(ModelSpec::parse(text), context);
}

bool is_model(const fs::path& path) {
  std::error_code unreadable;
  if (is_scene_file(path)) return true;
  if (!fs::is_directory(path, unreadable)) return path.extension() == ".bin" && is_eos_shape(path);
  if (is_there(path / "model.json")) return true;
  if (!neutral_of(path)) return eos_expressions_of(path) && eos_shape_of(path);
  return expressions_in(path) || identities_in(path) || meshes_in(path).size() == 1;
}

void write_model(const fs::path& folder, const MorphableModel& model,
                 const std::optional<WeightTrack>& performance, const WriteOptions& options,
                 const Context& context) {
  PendingOutputs outputs(options.overwrite, options.inputs, options.together);
  const fs::path pending = outputs.add(folder, PendingOutput::Kind::folder);
  write_mesh(pending / "neutral.ply", PositionsView(model.mean().data(), model.mean().rows(), 3),
             model.connectivity(), {.double_precision = true}, context.part(0, 0));
  const double half = model.identities().size() > 0 ? 0.5 : 1;
  write_shapes(pending / "expressions", model.expressions(), model, context.part(0, half));
  write_shapes(pending / "identities", model.identities(), model, context.part(half, 1));
  if (performance) write_weights(pending / "performance.csv", *performance, false);
  for (const auto& [name, content] : options.extra) write_bytes(pending / name, content);
  outputs.commit();
}

}  // namespace mimetra
