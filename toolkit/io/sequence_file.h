#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/io/mesh_file.h"
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

/// A sequence whose poses are read when they are needed, and what was noticed while opening it.
struct OpenSequence {
  std::shared_ptr<const FrameSource> frames;
  /// True for a model, with or without weights: its rest pose is its neutral.
  bool model_driven = false;
  /// Files it comes from, in order.
  std::vector<std::filesystem::path> files = {};
  /// Which weight names were not matched, and the like.
  std::vector<std::string> notes = {};
};

/// A sequence in memory and what was noticed while reading it.
struct SequenceRead {
  MeshSequence sequence;
  /// True for a model, with or without weights: its rest pose is its neutral.
  bool model_driven = false;
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
};

/// Opens `text`: a directory, glob or printf pattern of OBJ/PLY/OFF/STL files in natural order (2
/// before 10), a file in one of sequence_formats(), or a model with weights; a model without
/// weights is its neutral, and MODEL@NAME.fit.json the performance that was fitted. The rest pose
/// of a directory or of a file without faces is NAME.rest.ply where that stands beside it; its
/// faces are those of `topology` or NAME.topology.ply.
///
/// No frame is read but the first, for faces and where it stands in for the rest pose. Throws
/// IoError, MismatchError, std::invalid_argument for a bad frame range; reading frames throws
/// IoError, and MismatchError for frames that differ in vertices or faces, naming both files.
OpenSequence open_sequence(const std::string& text, const SequenceSource& source = {});

/// The same, with all frames in memory. Throws what opening and reading throw, Cancelled.
SequenceRead read_sequence(const std::string& text, const SequenceSource& source = {});

struct SequenceWriteOptions {
  /// Of the frames in a folder.
  MeshFormat format = MeshFormat::ply;
  /// Double precision in mesh files, which poses far from the origin have in any case; single
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

/// Further files (name, content) that appear together with an output: in its folder, or beside its
/// file.
using ExtraFiles = std::vector<std::pair<std::string, std::string>>;

/// Begins `target`: a file in the format of its extension (sequence_formats(); a mesh file takes
/// one frame), with NAME.topology.ply and, where the rest pose is known, NAME.rest.ply beside it
/// where the format has no place for them, or a folder of frame_0000.ply on (`frame_00000` and so
/// on where four digits do not suffice) with NAME.rest.ply beside it where the rest pose is known
/// (never for STL, which numbers the vertices anew). Atomic. Throws OutputError, MismatchError for
/// what the format cannot hold.
std::unique_ptr<FrameSink> begin_sequence(const SequenceHeader& header,
                                          const std::filesystem::path& target,
                                          const SequenceWriteOptions& = {},
                                          const ExtraFiles& extra = {});

/// Begins `target`, writes all frames and returns the files written. Throws what reading throws,
/// too, and Cancelled.
std::vector<std::filesystem::path> write_sequence(const FrameSource& sequence,
                                                  const std::filesystem::path& target,
                                                  const SequenceWriteOptions& = {},
                                                  const ExtraFiles& extra = {});

}  // namespace mimetra
