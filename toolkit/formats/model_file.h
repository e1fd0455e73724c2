#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/io/format.h"
#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Model directory or file, and an identity: `MODEL@identity003=1.5,identity007=-1`, or
/// `MODEL@NAME.fit.json` with fitted coefficients.
struct ModelSpec {
  std::filesystem::path path;
  std::vector<std::pair<std::string, double>> identity;
  /// Text after '@' as given, for naming outputs.
  std::string identity_text;
  /// File with fitted coefficients.
  std::optional<std::filesystem::path> fit = {};

  /// Parses `text`. If a file or folder has the whole text as its name, that is the path. Otherwise
  /// the last '@' separates path and identity, if no '/' follows it. If the text ends in .json, the
  /// first '@' after an existing path separates instead, or else the last '@'.
  ///
  /// Throws std::invalid_argument for an entry that is not NAME=NUMBER, a name given twice, and an
  /// empty path.
  static ModelSpec parse(const std::string& text);
  /// Name without folders and without a file's extension, such as `ict-face@identity007=2`.
  /// `sfm@out/target.fit.json` becomes `sfm@target`.
  std::string name() const;
  /// Warnings about coefficients above 10 in absolute value, and about a fit with one identity per
  /// frame. Reads the fit.
  std::vector<std::string> notes() const;
};

/// Reads a model. `path` leads to:
///  - a directory with `neutral.*` and `expressions/` or `targets/`, in any case, and optionally
///    `identities/`. Shapes are absolute; the reader subtracts the neutral. A shape's name is the
///    stem of its file.
///  - a directory with a `model.json` that lists these paths as `neutral`, `expressions` and
///    `identities`. For an eos model it has `shape` and, as `expressions`, the eos blendshape file.
///  - a directory with the eos pair `sfm_shape_*.bin` (or another .bin that starts like one) and
///    `expression_blendshapes_*.bin`, or the shape model of such a pair.
///  - a scene file (is_scene_file()).
///
/// Shapes are in the natural order of their names. Throws IoError; MismatchError if shapes differ
/// in topology; Cancelled.
MorphableModel read_model(const std::filesystem::path& path, const Context& context = {});

/// Files that read_model() reads, and landmark mappings and rules in the model's folder. Throws
/// IoError if model.json is not a JSON object of paths.
std::vector<std::filesystem::path> model_files(const std::filesystem::path& path);

/// Reads the model of a spec with the spec's identity. Throws as read_model() and read_fit(), and
/// MismatchError for an unknown identity name or a fit of another model.
BlendshapeModel read_person(const ModelSpec& spec, const Context& context = {});

/// Reads the person that `text` describes: a model, or `MODEL@identity003=1.5`. Throws as
/// ModelSpec::parse() and read_person().
BlendshapeModel read_blendshapes(const std::string& text, const Context& context = {});

/// True for scene files, eos shape models, and directories that look like a model of read_model().
/// A directory with `neutral.*` and other meshes, but without expressions or identities, is a
/// sequence with its rest pose.
bool is_model(const std::filesystem::path& path);

/// Mesh files in a model's folder that do not belong to it, such as frames, in natural order.
std::vector<std::filesystem::path> meshes_beside_model(const std::filesystem::path& path);

/// Notes on meshes in a model's folder that look like expressions but are not read. If the model
/// has no expressions, these are meshes in any folder and beside the neutral. Otherwise they are
/// meshes in subfolders of the expressions, and in folders with a usual name.
std::vector<std::string> notes_on_unread(const std::filesystem::path& path);

/// Writes a model directory: neutral.ply, expressions/NAME.ply and identities/NAME.ply (absolute
/// shapes, double precision), with a track also `performance.csv`, and the further files of the
/// options. Atomic. Throws OutputError, also for a name that cannot be a file name, and Cancelled.
void write_model(const std::filesystem::path& folder, const MorphableModel& model,
                 const std::optional<WeightTrack>& performance = {}, const WriteOptions& = {},
                 const Context& context = {});

}  // namespace mimetra
