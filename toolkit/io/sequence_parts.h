#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/io/mesh_file.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_options.h"

/// What formats of sequences have in common. Internal to them.
namespace mimetra {

/// Times of `frames` frames without any, by `source.fps` (F).
Eigen::VectorXd frame_times(int frames, const SequenceSource& source);

/// Throws IoError that names `name` and the first frame whose time is not finite, or not later than
/// the one before.
void check_times(const std::string& name, const Eigen::VectorXd& times);

/// The file with the faces of `path`, which has none itself. Throws IoError where there is none.
std::filesystem::path topology_of(const std::filesystem::path& path, const SequenceSource& source);

/// The rest pose beside a sequence, whose file is added to `files`; none where there is none.
std::optional<Positions> rest_beside(const std::filesystem::path& sequence,
                                     const MeshFileReader& reader,
                                     std::vector<std::filesystem::path>& files);

/// Add to an output, and to the list of its files, what belongs beside it: faces; the rest pose
/// where it is known (otherwise an old one goes); further files.
void add_topology_beside(PendingOutputs& outputs, const std::filesystem::path& sequence,
                         const SequenceHeader& header, std::vector<std::filesystem::path>& files);
void add_rest_beside(PendingOutputs& outputs, const std::filesystem::path& sequence,
                     const SequenceHeader& header, std::vector<std::filesystem::path>& files);
void add_extra_beside(PendingOutputs& outputs, const std::filesystem::path& target,
                      const ExtraFiles& extra, std::vector<std::filesystem::path>& files);

/// True where single precision would round motion away: `poses` lie far from the origin for a mesh
/// whose longest side is `extent`.
bool needs_double(const PositionsView& poses, double extent);

/// Throws MismatchError for these, of a `target` that holds single precision only.
void check_single_precision(const std::filesystem::path& target, const PositionsView& poses,
                            double extent);

}  // namespace mimetra
