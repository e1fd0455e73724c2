#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/io/format.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"

/// Shared parts of sequence formats: files beside a sequence, sequences with one mesh file a frame,
/// and models driven by weights. For code that opens and writes sequences.
namespace mimetra {

/// Another sequence with the same name, to which the files beside `sequence` belong; empty if there
/// is none.
std::filesystem::path other_of_name(const std::filesystem::path& sequence);

/// Path of the mesh file with the faces of `path`, which stores none itself. Throws IoError if
/// there is none.
std::filesystem::path topology_of(const std::filesystem::path& path, const ReadOptions& options);

/// Reads the rest pose beside a sequence and adds its file to `files`; none if it does not exist.
std::optional<Positions> rest_beside(const std::filesystem::path& sequence,
                                     const MeshFileReader& reader,
                                     std::vector<std::filesystem::path>& files);

/// Reads the times beside a sequence of `frames` frames and adds their file to `files`; none if it
/// does not exist. Throws IoError, and MismatchError for another number of times.
std::optional<Eigen::VectorXd> times_beside(const std::filesystem::path& sequence, int frames,
                                            std::vector<std::filesystem::path>& files);

/// Add companions to an output and to the list of its files: faces, the rest pose, the times, and
/// further files. If rest pose or times are not known, an old file of that name is removed.
void add_topology_beside(PendingOutputs& outputs, const std::filesystem::path& sequence,
                         const SequenceHeader& header, std::vector<std::filesystem::path>& files);
void add_rest_beside(PendingOutputs& outputs, const std::filesystem::path& sequence,
                     const SequenceHeader& header, std::vector<std::filesystem::path>& files);
void add_times_beside(PendingOutputs& outputs, const std::filesystem::path& sequence,
                      const SequenceHeader& header, std::vector<std::filesystem::path>& files);
void add_extra_beside(PendingOutputs& outputs, const std::filesystem::path& target,
                      const ExtraFiles& extra, std::vector<std::filesystem::path>& files);

/// Opens the frames of `series` that `options` selects. `folder` is the folder whose companions are
/// read, and is empty for patterns and single files. A rest pose beside the folder precedes the
/// series' own. Throws IoError, MismatchError, Cancelled.
OpenSequence open_frames(const FrameSeries& series, const std::filesystem::path& folder,
                         const ReadOptions& options, const Context& context = {});

/// Begins a folder of numbered files. Throws OutputError, Cancelled.
std::unique_ptr<FrameSink> begin_folder(const SequenceHeader& header,
                                        const std::filesystem::path& target,
                                        const WriteOptions& options, const Context& context = {});

/// Sequence of the model from `path`, driven by `options.weights`; without weights, its neutral.
/// Throws IoError, and MismatchError if no weight matches an expression.
OpenSequence drive(std::shared_ptr<const BlendshapeModel> model, const std::filesystem::path& path,
                   const ReadOptions& options);

/// Sequence of the model driven by a track that was read from `driver`. Throws MismatchError.
OpenSequence drive(std::shared_ptr<const BlendshapeModel> model, const std::filesystem::path& path,
                   const ReadOptions& options, const std::filesystem::path& driver,
                   WeightTrack track);

}  // namespace mimetra
