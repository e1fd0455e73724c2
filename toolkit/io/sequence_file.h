#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/mesh/progress.h"

namespace mimetra {

/// What a sequence's name does not say.
struct SequenceSource {
  /// Blendshape weights that drive a model.
  std::optional<std::filesystem::path> weights = {};
  /// Mesh file with the faces of an array.
  std::optional<std::filesystem::path> topology = {};
  /// Part `A:B:STEP` of the frames, 0-based, B excluded; each may be left out.
  std::optional<std::string> frames = {};
  /// Frames per second where the files say nothing of time, > 0.
  std::optional<double> fps = {};
  /// 0 for all there are; what is read does not depend on it.
  int threads = 0;
  Progress progress = {};
};

/// A sequence and what was noticed while reading it.
struct SequenceRead {
  MeshSequence sequence;
  /// True for a model, with or without weights: its rest pose is its neutral.
  bool model_driven = false;
  /// Files it came from, in order.
  std::vector<std::filesystem::path> files = {};
  /// Which weight names were not matched, and the like.
  std::vector<std::string> notes = {};
};

/// Reads `text`: a directory, glob or printf pattern of OBJ/PLY/OFF/STL files in natural order (2
/// before 10), one such file, an .npy array (faces from `topology` or NAME.topology.ply beside it),
/// or a model with weights; a model without weights is its neutral, and MODEL@NAME.fit.json the
/// performance that was fitted. The rest pose of an array or a
/// directory is NAME.rest.ply where that stands beside it. Throws IoError, MismatchError (frames
/// that differ in vertices or faces, naming both files), std::invalid_argument for a bad frame
/// range, Cancelled.
SequenceRead read_sequence(const std::string& text, const SequenceSource& source = {});

struct SequenceWriteOptions {
  /// Format of the frames in a folder: "ply", "obj", "off" or "stl".
  std::string format = "ply";
  /// Double precision in mesh files, which those far from the origin have in any case; single
  /// precision in arrays.
  bool double_precision = false;
  bool single_precision = false;
  bool overwrite = false;
  /// Files and folders that were read, which must stay.
  std::vector<std::filesystem::path> inputs = {};
  /// 0 for all there are; what is written does not depend on it.
  int threads = 0;
  Progress progress = {};
};

/// Writes `target`: NAME.npy (with NAME.topology.ply, and NAME.rest.ply where the rest pose is
/// known), one mesh file for a sequence of one frame, or a folder of frame_0000.ply on
/// (`frame_00000` and so on where four digits do not suffice) with NAME.rest.ply beside it where
/// the rest pose is known (never for STL, which numbers the vertices anew). Atomic. Returns the
/// files written. Throws OutputError, MismatchError for several frames into one mesh file. `extra`
/// are further files (name, content) that appear in the folder, or beside the file, together with
/// it.
std::vector<std::filesystem::path> write_sequence(
    const MeshSequence& sequence, const std::filesystem::path& target,
    const SequenceWriteOptions& = {},
    const std::vector<std::pair<std::string, std::string>>& extra = {});

}  // namespace mimetra
