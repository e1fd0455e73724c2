#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "toolkit/io/frame_series.h"
#include "toolkit/io/sequence_options.h"
#include "toolkit/mesh/context.h"

/// Sequences with a mesh file for each frame. Internal to sequence_file.h.
namespace mimetra {

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

}  // namespace mimetra
