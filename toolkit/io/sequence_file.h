#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "toolkit/io/sequence_format.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// A sequence in memory and what was noticed while reading it.
struct SequenceRead {
  MeshSequence sequence;
  /// True for a model, with or without weights: its rest pose is its neutral.
  bool model_driven = false;
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
};

/// Opens `text`: a directory, glob or printf pattern of OBJ/PLY/OFF/STL/OM files in natural order
/// (2 before 10), a file in one of sequence_formats(), or a model with weights; a model without
/// weights is its neutral, and MODEL@NAME.fit.json the performance that was fitted. The rest pose
/// of a directory or of a file without faces is NAME.rest.ply where that stands beside it; its
/// faces are those of `topology` or NAME.topology.ply.
///
/// No frame is read but the first, for faces and where it stands in for the rest pose. Throws
/// IoError, MismatchError, std::invalid_argument for a bad frame range and for options out of
/// range, Cancelled; reading frames throws IoError, and MismatchError for frames that differ in
/// vertices or faces, naming both files.
OpenSequence open_sequence(const std::string& text, const SequenceSource& source = {},
                           const Context& context = {});

/// The same, with all frames in memory. Throws what opening and reading throw.
SequenceRead read_sequence(const std::string& text, const SequenceSource& source = {},
                           const Context& context = {});

/// Begins `target`: a file in the format of its extension (sequence_formats(); a mesh file takes
/// one frame), with NAME.topology.ply and, where the rest pose is known, NAME.rest.ply beside it
/// where the format has no place for them, or a folder of frame_0000.ply on (`frame_00000` and so
/// on where four digits do not suffice) with NAME.rest.ply beside it where the rest pose is known
/// (never for STL, which numbers the vertices anew). Atomic. Throws OutputError, MismatchError for
/// what the format cannot hold, std::invalid_argument for options out of range and for an extension
/// that no format has (a folder's name ends in '/' or has no dot), Cancelled.
std::unique_ptr<FrameSink> begin_sequence(const SequenceHeader& header,
                                          const std::filesystem::path& target,
                                          const SequenceWriteOptions& = {},
                                          const ExtraFiles& extra = {},
                                          const Context& context = {});

/// Begins `target`, writes all frames and returns the files written. Throws what reading throws,
/// too.
std::vector<std::filesystem::path> write_sequence(const FrameSource& sequence,
                                                  const std::filesystem::path& target,
                                                  const SequenceWriteOptions& = {},
                                                  const ExtraFiles& extra = {},
                                                  const Context& context = {});

/// Files that stand beside a sequence which is about to be written, and that its own parts may not
/// replace: "take.rest.ply: belongs to 'take.pc2', ...". Whether it has such a part, and one with
/// another content, is known when it is written.
std::vector<std::string> refused_companions(const std::filesystem::path& sequence, bool overwrite);

/// The same of a model, regions or a table, whose parts are those of the format alone (.gltf, .pvd)
/// and, where it may be paired, a correspondence.
std::vector<std::string> refused_parts(const std::filesystem::path& file, bool overwrite,
                                       bool may_be_paired);

}  // namespace mimetra
