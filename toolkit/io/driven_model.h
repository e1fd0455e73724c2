#pragma once

#include <filesystem>
#include <memory>

#include "toolkit/io/sequence_options.h"
#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"

/// Sequences that are a model driven by weights. Internal to those that open sequences.
namespace mimetra {

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
