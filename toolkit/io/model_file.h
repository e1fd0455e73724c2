#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// A model directory or file, and the identity asked for: `MODEL@identity003=1.5,identity007=-1`,
/// or `MODEL@NAME.fit.json` with fitted coefficients.
struct ModelSpec {
  std::filesystem::path path;
  std::vector<std::pair<std::string, double>> identity;
  /// Everything after '@', as given; for naming outputs.
  std::string identity_text;
  /// Coefficients that were fitted.
  std::optional<std::filesystem::path> fit = {};

  /// The '@' counts after the last '/' (where a .json follows: the first one that follows something
  /// that exists), and only where nothing has the whole text as its name.
  /// Throws std::invalid_argument for what is not NAME=NUMBER after it, a name given twice, and
  /// where there is no path.
  static ModelSpec parse(const std::string& text);
  /// `ict-face@identity007=2`, without folders; a file without its extension; `sfm@target` for
  /// `sfm@out/target.fit.json`.
  std::string name() const;
  /// What is to be said of coefficients that nobody means.
  std::vector<std::string> notes() const;
};

class PendingOutputs;

/// Reads a directory with `neutral.*` and `expressions/` or `targets/`, in any case, and optionally
/// `identities/` (absolute shapes, their neutral subtracted on reading; the file's stem is the
/// name), or a `model.json` that names them (`neutral`, `expressions`, `identities`, or `shape` for
/// an eos model file with `expressions` its eos blendshape file), or the eos pair `sfm_shape_*.bin`
/// (or another .bin that starts like one) and `expression_blendshapes_*.bin`. `path` may also be
/// the shape model of such a pair. Shapes come in the natural order of their names. Throws IoError;
/// MismatchError if shapes differ in topology; Cancelled.
MorphableModel read_model(const std::filesystem::path& path, const Context& context = {});

/// The files that read_model reads of `path`, and the landmark mappings and rules in its folder,
/// but not what else lies there. Throws IoError for a model.json that is none.
std::vector<std::filesystem::path> model_files(const std::filesystem::path& path);

/// The person that a spec names. Throws as read_model and read_fit; MismatchError for an unknown
/// identity name, and for a fit of another model.
BlendshapeModel read_person(const ModelSpec& spec, const Context& context = {});

/// The person that `text` names: a model, or `MODEL@identity003=1.5`. Throws as
/// ModelSpec::parse and read_person.
BlendshapeModel read_blendshapes(const std::string& text, const Context& context = {});

/// True for a directory that looks like something read_model reads, and for an eos shape model;
/// another file is not a model. A directory of `neutral.*` and other meshes without expressions or
/// identities is a sequence with its rest pose.
bool is_model(const std::filesystem::path& path);

/// Mesh files in a model's folder that are no part of it, such as frames, in natural order.
std::vector<std::filesystem::path> meshes_beside_model(const std::filesystem::path& path);

/// What to say of meshes in a model's folder that could be its expressions and are not read: in any
/// folder where it has none, else in folders of theirs and beside, by their names.
std::vector<std::string> notes_on_unread(const std::filesystem::path& path);

/// Writes a model directory: neutral.ply, expressions/NAME.ply, identities/NAME.ply (absolute
/// shapes, double precision), and `performance.csv` when there is a track. `extra` are further
/// files (name, content) that appear in the folder together with them. Atomic. Throws OutputError,
/// also for a name that cannot be a file's, and Cancelled.
void write_model(const std::filesystem::path& folder, const MorphableModel& model,
                 const std::optional<WeightTrack>& performance, bool overwrite,
                 const std::vector<std::pair<std::string, std::string>>& extra = {},
                 PendingOutputs* together = nullptr, const Context& context = {});

}  // namespace mimetra
