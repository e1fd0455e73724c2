#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/io/frame_series.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"

/// What formats of sequences have in common: what stands beside a file, sequences with a mesh file
/// for each frame, and models that weights drive. Internal to what opens and writes sequences.
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

/// Another sequence of the name of `sequence`, a part of which is what stands beside that; empty
/// where there is none.
std::filesystem::path other_of_name(const std::filesystem::path& sequence);

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

/// The part of `series` that `source` takes. `folder` is where a rest pose may lie beside, which
/// comes before the series' own; empty for patterns and single files. Throws IoError,
/// MismatchError, Cancelled.
OpenSequence open_frames(const FrameSeries& series, const std::filesystem::path& folder,
                         const SequenceSource& source, const Context& context = {});

/// A folder of numbered files. Throws OutputError, Cancelled.
std::unique_ptr<FrameSink> begin_folder(const SequenceHeader& header,
                                        const std::filesystem::path& target,
                                        const SequenceWriteOptions& options,
                                        const ExtraFiles& extra, const Context& context = {});

/// The model that was read from `path`, driven by `source.weights`; without them, its neutral.
/// Throws IoError; MismatchError where no name of the weights is known.
OpenSequence drive(std::shared_ptr<const BlendshapeModel> model, const std::filesystem::path& path,
                   const SequenceSource& source);

/// The same driven by a track that was read from `driver`. Throws MismatchError.
OpenSequence drive(std::shared_ptr<const BlendshapeModel> model, const std::filesystem::path& path,
                   const SequenceSource& source, const std::filesystem::path& driver,
                   WeightTrack track);

/// A scene's file: driven by `source.weights`, else what it performs, else its neutral. Throws
/// IoError, MismatchError, Cancelled.
OpenSequence open_scene(const std::filesystem::path& path, const SequenceSource& source,
                        const Context& context = {});

}  // namespace mimetra
