#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "toolkit/io/format.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Sequence in memory, and notes from reading it.
struct SequenceRead {
  MeshSequence sequence;
  /// True if the rest pose is a model's neutral, whether or not weights drive the model.
  bool model_driven = false;
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
  /// Fields on the mesh, for formats that have them.
  std::vector<Field> fields = {};
};

/// Opens `text`, which names:
///  - a directory, glob or printf pattern of OBJ/PLY/OFF/STL/OM files in natural order (2 before
///    10);
///  - a file in a format of formats();
///  - a model, which `options.weights` drive; without weights it stays at its neutral;
///  - a model with a fit, MODEL@NAME.fit.json, which gives the fitted performance.
///
/// The rest pose of a directory, or of a file without faces, is NAME.rest.ply beside it, if that
/// exists. Faces of such a file come from `topology` or NAME.topology.ply.
///
/// Opening reads only the first frame, for faces and as a substitute for the rest pose. Throws
/// IoError, MismatchError, Cancelled, and std::invalid_argument for a bad frame range and for
/// options out of range. Reading frames throws IoError, and MismatchError with both files if frames
/// differ in vertices or faces.
OpenSequence open_sequence(const std::string& text, const ReadOptions& options = {},
                           const Context& context = {});

/// Opens a sequence and reads all frames into memory. Throws as open_sequence() and as reading
/// frames.
SequenceRead read_sequence(const std::string& text, const ReadOptions& options = {},
                           const Context& context = {});

/// Begins to write `target`, in one of two forms:
///  - A file in the format of its extension (formats()); a mesh file takes one frame.
///    Parts that the format cannot store go beside it: NAME.topology.ply and, if the rest pose is
///    known, NAME.rest.ply.
///  - A folder of frame_0000.ply and so on, with more digits if four do not suffice. A known rest
///    pose goes to NAME.rest.ply beside it, except for STL, which renumbers the vertices. A
///    folder's name ends in '/' or has no dot.
///
/// Atomic. Throws OutputError, MismatchError for data that the format cannot store, Cancelled, and
/// std::invalid_argument for options out of range and for an unknown extension.
std::unique_ptr<FrameSink> begin_sequence(const SequenceHeader& header,
                                          const std::filesystem::path& target,
                                          const WriteOptions& = {}, const Context& context = {});

/// Writes all frames to `target` and returns the files written. Throws as begin_sequence() and as
/// reading the frames.
std::vector<std::filesystem::path> write_sequence(const FrameSource& sequence,
                                                  const std::filesystem::path& target,
                                                  const WriteOptions& = {},
                                                  const Context& context = {});

/// Reads and writes a sequence with its fields as one value, for tables of formats. Throw as
/// open_sequence() and write_sequence().
ReadValue read_sequence_value(const std::string& text, const ReadOptions& options = {},
                              const Context& context = {});
Format::Paths write_sequence_value(const Data& data, const std::filesystem::path& target,
                                   const WriteOptions& = {}, const Context& context = {});

/// Messages about existing files that the companions of `sequence` may not replace, such as
/// "take.rest.ply: belongs to 'take.pc2', ...". Call it before writing, which alone decides whether
/// the sequence has such a companion with other content.
std::vector<std::string> refused_companions(const std::filesystem::path& sequence, bool overwrite);

/// Messages of the same kind for a model, regions or a table. Their companions are the second files
/// of a format (.gltf, .pvd) and, if `may_be_paired`, a correspondence.
std::vector<std::string> refused_parts(const std::filesystem::path& file, bool overwrite,
                                       bool may_be_paired);

}  // namespace mimetra
