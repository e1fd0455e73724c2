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

/// Seconds of the frames of a sequence (F), and whether anybody gave them.
struct FrameTimes {
  Eigen::VectorXd seconds;
  bool are_known;
};

/// Those of `name`, whose own are `known`; where it has none, they follow from `source.fps`. Throws
/// std::invalid_argument where it has some and `source.fps` says others.
FrameTimes frame_times(const std::string& name, int frames, std::optional<Eigen::VectorXd> known,
                       const SequenceSource& source);

/// Throws IoError that names `name` and the first frame whose time is not finite, or not later than
/// the one before.
void check_times(const std::string& name, const Eigen::VectorXd& times);

/// The file with the faces of `path`, which has none itself. Throws IoError where there is none.
std::filesystem::path topology_of(const std::filesystem::path& path, const SequenceSource& source);

/// The rest pose beside a sequence, whose file is added to `files`; none where there is none.
std::optional<Positions> rest_beside(const std::filesystem::path& sequence,
                                     const MeshFileReader& reader,
                                     std::vector<std::filesystem::path>& files);

/// The times beside a sequence of `frames` frames, whose file is added to `files`; none where there
/// is none. Throws IoError, MismatchError for another number.
std::optional<Eigen::VectorXd> times_beside(const std::filesystem::path& sequence, int frames,
                                            std::vector<std::filesystem::path>& files);

/// Add to an output, and to the list of its files, what belongs beside it: faces; the rest pose and
/// the times where they are known (otherwise old ones go); further files.
void add_topology_beside(PendingOutputs& outputs, const std::filesystem::path& sequence,
                         const SequenceHeader& header, std::vector<std::filesystem::path>& files);
void add_rest_beside(PendingOutputs& outputs, const std::filesystem::path& sequence,
                     const SequenceHeader& header, std::vector<std::filesystem::path>& files);
void add_times_beside(PendingOutputs& outputs, const std::filesystem::path& sequence,
                      const SequenceHeader& header, std::vector<std::filesystem::path>& files);
void add_extra_beside(PendingOutputs& outputs, const std::filesystem::path& target,
                      const ExtraFiles& extra, std::vector<std::filesystem::path>& files);

}  // namespace mimetra
